"""A small RRT in joint space round a wall, beside the planner: how long its paths are, and whether they are free."""

import math

import numpy as np

import mjarm

robot = mjarm.Robot(mjarm.Robot("ur5e").file.with_name("wall.xml"))
start = np.array([1.9084, -1.2456, 1.9905, -2.3157, -1.5708, 3.4792])
plan = robot.plan(start, mjarm.Pose([-0.3, -0.45, 0.2], euler=[math.pi, 0, 0]))
goal, bad = plan.path[-1], []


def rrt(step, seed):  # S. LaValle, 1998: a tree grows towards random joint values, now and then towards the goal
    rng = np.random.default_rng(seed)
    low, high = np.minimum(start, goal) - 0.8, np.maximum(start, goal) + 0.8
    tree, parent = [start], [0]
    while not np.allclose(tree[-1], goal):
        target = goal if rng.random() < 0.1 else rng.uniform(low, high)
        near = np.linalg.norm(np.array(tree) - target, axis=1).argmin()
        way = target - tree[near]
        q = tree[near] + way * min(1, step / max(np.linalg.norm(way), 1e-9))
        if robot.check(q, margin=0).free:  # the end of the edge; nobody looks at what lies between
            tree.append(q)
            parent.append(near)
    path = [len(tree) - 1]
    while path[-1] > 0:
        path.append(parent[path[-1]])
    return np.array(tree)[path[::-1]]


for step in 0.5, 0.1, 0.05:
    paths = [rrt(step, seed) for seed in range(1, 21)]
    length = np.mean([np.linalg.norm(np.diff(path, axis=0), axis=1).sum() for path in paths])
    between = [[a + (b - a) * t for a, b in zip(path, path[1:]) for t in np.arange(0, 1, 0.05)] for path in paths]
    bad.append(sum(not all(robot.check(q, margin=0).free for q in rows) for rows in between))
    print(f"RRT, steps of {step} rad: {length:.2f} rad on the average, {bad[-1]} of 20 paths go through something")
print(f"robot.plan: {plan.length:.2f} rad, {robot.verify(plan) or 'every edge proved free'}")
raise SystemExit(bad[0] < bad[1] or bool(robot.verify(plan)))
