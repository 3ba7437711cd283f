"""Three ways of control on one motion: how far the tool ends from where it should be."""

import mjarm

robot = mjarm.Robot("ur5e")
stretched = [-1.57, -0.5, 0.4, -1.3, -1.57, 0]  # [rad]
motion = robot.time([robot.home, stretched], share=0.5)
for control in ("servo", "servo_gravity", "computed_torque"):
    report = robot.simulate(motion, control=control, rest=2).report
    print(f"{control:16} static error {1e3 * report['static_error']['position']:8.4f} mm, "
          f"torque used {100 * report['limits_used']['torque']:3.0f} %")
