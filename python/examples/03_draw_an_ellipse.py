"""From a curve to joint motion in time: IK along the curve, then timing within the joint limits."""

import numpy as np

import mjarm

robot = mjarm.Robot("ur5e")
curve = mjarm.Curve.ellipse([0, -0.3, 0.5], a=0.3, b=0.15, euler=[3.14, 0, 0])
path = robot.follow(curve, robot.home)
if not path.ok:
    raise SystemExit(path.message)
motion = robot.time(path, tool_speed=0.25)
t, q, v, a = motion.sample(0.002)
used = max((np.abs(v) / robot.limits.velocity).max(), (np.abs(a) / robot.limits.acceleration).max())
print(f"{curve.length:.3f} m of curve in {motion.duration:.2f} s, largest joint step {path.max_joint_step:.4f} rad, "
      f"limits used {100 * used:.0f} %")
