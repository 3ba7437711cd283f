"""Joint values for a grid of tool poses on all cores, then a tool that is led after a moving target."""

import math

import numpy as np

import mjarm

robot = mjarm.Robot("ur5e")
x, y = np.meshgrid(np.arange(0.3, 0.8, 0.01), np.arange(-0.25, 0.25, 0.01), indexing="ij")
pos = np.stack([x.ravel(), y.ravel(), np.full(x.size, 0.2)], axis=1)
quat = np.tile(mjarm.Pose(euler=[math.pi, 0, 0]).quat, (x.size, 1))
q, solved = robot.ik_batch((pos, quat), robot.home)
worst = np.linalg.norm(robot.fk_batch(q[solved])[:, :3, 3] - pos[solved], axis=1).max()
print(f"{solved.sum()} of {len(pos)} poses solved, at worst {worst:.1e} m off")

tracker = robot.tracker(dt=0.01)
now, target, behind = robot.home, robot.fk(robot.home), 0.0
for _ in range(100):
    target = mjarm.Pose(target.pos - [0, 0, 0.001], quat=target.quat)  # 0.1 m/s
    step = tracker.step(target, now)
    behind, now = max(behind, step.pos_err), step.q
print(f"followed the target for 1 s, at most {1e3 * behind:.1f} mm behind")
