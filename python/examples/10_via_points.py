"""Joint waypoints passed without a stop, as fast as the joints allow, and executed in MuJoCo."""

import numpy as np

import mjarm

robot = mjarm.Robot("ur5e")
waypoints = np.tile(robot.home, (5, 1))  # [rad]
waypoints[1:4, 0] += [0.4, 0.8, 0.3]
waypoints[2:4, 2] -= [0.4, 0.2]
motion, times = robot.time_via(waypoints)
for t in times:
    q, v, a = motion.at(t)
    print(f"waypoint at {t:.3f} s, passed at up to {np.abs(v).max():.2f} rad/s")
run = robot.simulate(motion)
error = np.abs(run.log["q"] - run.log["q_ref"]).max()
print(f"{motion.duration:.2f} s, joints within {error:.1g} rad of it, {100 * run.report['limits_used']['torque']:.0f} % of the torque used")
