"""Load a robot, find its arm, and ask where the tool is."""

import mjarm

robot = mjarm.Robot("ur5e")  # or the path of any MJCF or URDF file
tool = robot.fk(robot.home)
print(f"{robot.name} has {robot.dof} joints; at home its {robot.tip} is at {tool.pos.round(3)} m")
print(f"quaternion [w x y z] = {tool.quat.round(4)}, manipulability {robot.manipulability(robot.home):.4f}")
