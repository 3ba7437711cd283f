"""What hangs at the tool, and how much friction the joints have, from a log of the arm in motion."""

import mjarm

robot = mjarm.Robot("ur5e")
motion = mjarm.excitation(robot, seconds=10)  # every joint to and fro, free of contact
hung = mjarm.Payload(1.5, [0.01, -0.02, 0.04])  # [kg], [m] in the frame of the tool
log = robot.simulate(motion, payload=hung).log  # of a real arm: mjarm.read_joint_log("log.csv", robot)

found = mjarm.identify(robot, mjarm.JointLog(robot.timestep, log["q"], log["torque"]))
assert found.payload  # it was asked for
print(found.payload)
for joint in found.joints:
    print(joint)
print(f"unexplained: {100 * max(joint.unexplained for joint in found.joints):.3f} % of a torque limit")

# What is found goes back in.
run = mjarm.Program.load("movel").run(payload=found.payload.value)
print(f"a program that knows it: {run}")
