"""Joint values along a line, or where it stops, why, and what mends it."""

import mjarm

robot = mjarm.Robot("ur5e")
down = [3.14159265, 0, 0]
path = robot.line(mjarm.Pose([0.4, -0.4, 0.4], euler=down), mjarm.Pose([-0.4, -0.4, 0.4], euler=down), robot.home)
print(f"{len(path)} waypoints, joint steps up to {path.max_joint_step:.3f} rad, "
      f"manipulability {path.manipulability:.3f} or more")

# Through the first axis, where this arm cannot be.
bad = robot.line(mjarm.Pose([0.4, -0.05, 0.4], euler=down), mjarm.Pose([-0.4, -0.05, 0.4], euler=down), robot.home)
print(f"{100 * bad.fraction:.0f} % of it: {bad.message}")
for fix in bad.fixes:
    print(f"It works if you {fix}.")
