"""Is everything here? One robot loaded, one pose reached, one motion simulated, one picture."""

import mjarm

print(f"MuJoCo {mjarm.mujoco_version()}, models: {', '.join(mjarm.shipped_models())}")
robot = mjarm.Robot("ur5e")
down = mjarm.Pose([-0.13, 0.6, 0.1], euler=[3.14, 0, 1.57])  # metres and radians
motion = robot.time_between(robot.home, robot.ik(down).q)
run = robot.simulate(motion)
off, turned = robot.fk(run.log["q"][-1]).difference(down)
print(f"{motion.duration:.2f} s of motion, at its end the tool is {1e3 * off:.4f} mm and {turned:.4f} rad from the goal")
try:
    run.picture("first.png", width=640, height=360)
    print("first.png")
except mjarm.NotAvailable as why:
    print(f"no picture on this machine: {why}")
raise SystemExit(0 if off < 1e-4 else 1)
