"""A path round a wall, every edge of it proved free, timed and run in MuJoCo."""

import math

import mjarm

robot = mjarm.Robot(mjarm.Robot("ur5e").file.with_name("wall.xml"))
# From before the wall to behind it, with 20 mm kept to everything.
before = [1.9084, -1.2456, 1.9905, -2.3157, -1.5708, 3.4792]
behind = mjarm.Pose([-0.3, -0.45, 0.2], euler=[math.pi, 0, 0])
plan = robot.plan(before, behind, rounds=8, clearance=0.02)
motion = robot.time(plan)  # its corners are cut or swung round as far as that is proved as well
run = robot.simulate(motion)
print(f"{len(plan) - 1} edges of {plan.length:.2f} rad in {motion.duration:.2f} s, "
      f"{'without a contact' if run else run.message}; {robot.verify(plan) or 'judged valid by MuJoCo'}")
