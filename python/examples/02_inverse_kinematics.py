"""Joint values for a tool pose, and an honest reason where there are none."""

import mjarm

robot = mjarm.Robot("ur5e")
goal = mjarm.Pose([-0.13, 0.6, 0.1], euler=[3.14, 0, 1.57])  # about the fixed axes x, y, z
solution = robot.ik(goal)
print(f"q = {solution.q.round(4)}  (error {solution.pos_err:.1e} m, {solution.rot_err:.1e} rad)")

try:
    robot.ik(mjarm.Pose([0, 0.05, 0.5], quat=goal.quat))  # too near the base axis for this arm
except mjarm.Unreachable as failure:
    print(f"(0, 0.05, 0.5): {failure}")
