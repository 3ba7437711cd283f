#include "mjarm/model/servo_range.hpp"

#include <algorithm>

namespace mjarm {

ServoRange servo_range(const ArmJoint& joint) noexcept {
  if (!joint.actuator || !(joint.actuator->bias[1] < 0)) return {};
  const ArmActuator& servo = *joint.actuator;
  // It rests where gain * ctrl + bias[0] = -bias[1] * gear * q. A gear may turn it round.
  const auto rest = [&servo](double ctrl) {
    return (servo.gain * ctrl + servo.bias[0]) / (-servo.bias[1] * servo.gear);
  };
  const auto [lower, upper] = std::minmax({rest(servo.ctrl_lower), rest(servo.ctrl_upper)});
  return {lower, upper};
}

}  // namespace mjarm
