#pragma once

#include "mjarm/model/arm.hpp"

namespace mjarm {

/// Force of `actuator` [N m or N, before the gear] at ctrl `ctrl`, joint value `q` and joint
/// velocity `v`, without its limits.
[[nodiscard]] double actuator_force(const ArmActuator& actuator, double ctrl, double q, double v);

/// The ctrl with which `actuator` gives the joint torque `torque` [N m or N] at `q`, `v`; the
/// inverse of gear * actuator_force. Not limited.
[[nodiscard]] double ctrl_for_torque(const ArmActuator& actuator, double torque, double q,
                                     double v);

/// Position stiffness at the joint, K = -gear^2 bias[1] [N m/rad or N/m]; > 0 for a position servo.
[[nodiscard]] double servo_stiffness(const ArmActuator& actuator);

/// Velocity damping at the joint, D = -gear^2 bias[2] [N m s/rad or N s/m].
[[nodiscard]] double servo_damping(const ArmActuator& actuator);

}  // namespace mjarm
