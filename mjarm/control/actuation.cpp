#include "mjarm/control/actuation.hpp"

namespace mjarm {

double actuator_force(const ArmActuator& actuator, double ctrl, double q, double v) {
  return actuator.gain * ctrl + actuator.bias[0] + actuator.bias[1] * actuator.gear * q +
         actuator.bias[2] * actuator.gear * v;
}

double ctrl_for_torque(const ArmActuator& actuator, double torque, double q, double v) {
  return (torque / actuator.gear - actuator_force(actuator, 0, q, v)) / actuator.gain;
}

double servo_stiffness(const ArmActuator& actuator) {
  return -actuator.gear * actuator.gear * actuator.bias[1];
}

double servo_damping(const ArmActuator& actuator) {
  return -actuator.gear * actuator.gear * actuator.bias[2];
}

}  // namespace mjarm
