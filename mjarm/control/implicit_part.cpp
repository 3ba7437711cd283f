#include "mjarm/control/implicit_part.hpp"

#include <algorithm>

#include "mjarm/control/actuation.hpp"

namespace mjarm {

ImplicitPart implicit_part(const StepRule& rule, int dof, double damping,
                           const std::optional<ArmActuator>& actuator) {
  const double h = rule.timestep;
  const bool discrete = rule.integrator == Integrator::discrete;
  const bool implicit_actuators = rule.integrator == Integrator::implicit ||
                                  rule.integrator == Integrator::implicitfast || discrete;
  double D = rule.implicit_damping ? damping : 0;
  if (implicit_actuators && actuator) D += servo_damping(*actuator);
  if (!discrete) return {.mass = h * D, .stiffness = 0};
  // Only what stabilises enters there.
  D = std::max(D, 0.0);
  double K = rule.stiffness[static_cast<std::size_t>(dof)];
  if (actuator) K += std::max(servo_stiffness(*actuator), 0.0);
  return {.mass = h * D + h * h * K, .stiffness = K};
}

}  // namespace mjarm
