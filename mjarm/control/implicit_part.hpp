#pragma once

#include <optional>

#include "mjarm/model/arm.hpp"
#include "mjarm/model/step_rule.hpp"

namespace mjarm {

/// What the integrator takes of a hinge or slide at the end of a step instead of at its start: with
/// a step h, velocity v and acceleration a it works like the force -(mass a + stiffness h v).
struct ImplicitPart {
  double mass = 0;       ///< [kg m^2 or kg] h D + h^2 K, >= 0
  double stiffness = 0;  ///< [N m/rad or N/m] K
};

/// D is `damping` [N m s/rad or N s/m] and the velocity gain of `actuator`, K the position gains,
/// as far as the integrator is implicit in them (MuJoCo documentation, Computation, "Numerical
/// integration"): joint damping for Euler; also the actuators' velocity gains for implicitfast and
/// implicit; also springs and position gains for `discrete`.
/// @param dof  of the joint.
[[nodiscard]] ImplicitPart implicit_part(const StepRule& rule, int dof, double damping,
                                         const std::optional<ArmActuator>& actuator);

}  // namespace mjarm
