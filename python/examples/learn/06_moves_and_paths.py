"""Inverse kinematics at both ends and joints in between: how far the tool is off the straight line, and what cures it."""

import math

import numpy as np

import mjarm

robot = mjarm.Robot("ur5e")
down = [math.pi, 0, 0]
begin = mjarm.Pose([0.3, -0.4, 0.3], euler=down)
end = mjarm.Pose([-0.3, -0.4, 0.3], euler=down)


def off_line(q):
    """The farthest any row puts the tool off the straight line from begin to end [mm]."""
    p = robot.fk_batch(q)[:, :3, 3] - begin.pos
    along = (end.pos - begin.pos) / np.linalg.norm(end.pos - begin.pos)
    return 1e3 * np.linalg.norm(p - np.outer(p @ along, along), axis=1).max()


def joint_moves(n):
    """Inverse kinematics at n + 1 points of the line, joint values interpolated in between."""
    q = [robot.ik(begin).q]
    for k in range(1, n + 1):
        q.append(robot.ik(begin.interpolate(end, k / n), seed=q[-1]).q)
    at = np.linspace(0, n, 64 * n + 1)
    return np.stack([np.interp(at, range(n + 1), joint) for joint in np.transpose(q)], axis=1)


for pieces in (1, 2, 4, 8, 16):
    print(f"{pieces:2} joint moves: off the line by up to {off_line(joint_moves(pieces)):.2f} mm")

motion = robot.time(robot.line(begin, end, joint_moves(1)[0]))  # MoveL
straight = off_line(motion.sample(0.002)[1])
print("MoveL: under 0.001 mm" if straight < 1e-3 else f"MoveL: {straight:.3f} mm")
run = robot.simulate(motion)
print(f"{motion.duration:.2f} s, executed in MuJoCo {'on' if run.report['path_error_max'] < 1e-6 else 'beside'} the line")
raise SystemExit(not (run and straight < 1e-3 and off_line(joint_moves(1)) > 99))
