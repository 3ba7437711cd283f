"""Three pits of a naive follower: no answer, a flip, a singularity; and what mjarm makes of each."""

import math

import numpy as np

import mjarm

robot = mjarm.Robot("ur5e")
home = robot.fk(robot.home)


def least_squares(goal, q):  # damped; gives back whatever it has in the end
    for _ in range(300):
        X, J = robot.fk(q), robot.jacobian(q)
        turn = 0.5 * sum(np.cross(X.rotation[:, i], goal.rotation[:, i]) for i in range(3))
        q = q + J.T @ np.linalg.solve(J @ J.T + 0.1 * np.eye(6), [*(goal.pos - X.pos), *turn])
    return q


def largest_step(begin, end, q):  # of any joint, always with the answer nearest to the one before
    rows = [q]
    for k in range(301):
        rows.append(robot.ik(begin.interpolate(end, k / 300), seed=rows[-1]).q)
    return np.abs(np.diff(rows[1:], axis=0)).max()


far = mjarm.Pose([-0.134, 1.0, 0.2], quat=home.quat)
off = robot.fk(least_squares(far, robot.home)).difference(far)[0]
path = robot.line(home, far, robot.home)
print(f"1 no answer: least squares has one, {1e3 * off:.0f} mm off\n  mjarm: {path.message}\n  it would do to {path.fixes[0]}")
ends = [mjarm.Pose([x, -0.4, 0.5], euler=[math.pi, 0, 0]) for x in (-0.1, 0.6)]
jump, flip = largest_step(*ends, robot.home), robot.line(*ends, robot.home)
print(f"2 flip: a joint jumps by {math.degrees(jump):.0f} deg\n  mjarm: steps of {flip.max_joint_step:.4f} rad, from {flip.q[0].round(2)}")
ends = [mjarm.Pose([x, -0.45, 0.45], euler=[0, math.radians(92), 0]) for x in (-0.25, 0.35)]
past = robot.line(*ends, robot.home)
speed, motion = largest_step(*ends, past.q[0]) / 0.008, robot.time(past)
used = np.abs(motion.sample(0.002)[2]).max()
print(f"3 singularity: {speed:.1f} rad/s at 0.25 m/s\n  mjarm: {used:.2f} rad/s, the tool slows down to {motion.dips[0][2]:.3f} m/s")
raise SystemExit(bool(path.ok or off < 0.09 or jump < 2.6 or not flip.ok or speed < 15 or used > 3.142))
