"""A picture of a robot and of the path that its tool drew, without a window."""

import mjarm

robot = mjarm.Robot("ur5e")
ellipse = mjarm.Curve.ellipse([0, -0.5, 0.4], a=0.3, b=0.15, euler=[3.14, 0, 0])
run = robot.simulate(robot.time(robot.follow(ellipse)))
try:
    run.picture("picture.png", width=640, height=360)
    print("picture.png")
except mjarm.NotAvailable as why:
    print(f"no picture on this machine: {why}")
run.plot("plot.png")
print("plot.png")
