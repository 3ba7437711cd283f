#include "mjarm/control/sag.hpp"

#include "mjarm/control/actuation.hpp"
#include "mjarm/control/step_inverse.hpp"

namespace mjarm {

JointVec static_sag(const Model& model, const Arm& arm, std::span<const double> qpos) {
  JointVec sag = StepInverse(model, arm).holding_torque(qpos);
  for (int i = 0; i < arm.dof(); ++i) {
    const auto& actuator = arm.joints[i].actuator;
    const double stiffness = actuator ? servo_stiffness(*actuator) : 0;
    sag[i] = stiffness > 0 ? sag[i] / stiffness : 0;
  }
  return sag;
}

}  // namespace mjarm
