#include "mjarm/execution/beyond_servo.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/core/messages/execution.hpp"
#include "mjarm/model/servo_range.hpp"

namespace mjarm {

std::optional<BeyondServo> beyond_servo(const Arm& arm, const Trajectory& motion) {
  constexpr double kStep = 0.01;  // [s]
  double farthest = 0.01;         // [rad or m]
  std::optional<BeyondServo> found;
  const auto looks = static_cast<int>(std::ceil(motion.duration() / kStep));
  for (int k = 0; k <= looks; ++k) {
    const JointVec q = motion.at(k * kStep).q;
    for (int i = 0; i < arm.dof(); ++i) {
      const ServoRange range = servo_range(arm.joints[static_cast<std::size_t>(i)]);
      const double beyond = std::max(range.lower - q[i], q[i] - range.upper);
      if (beyond <= farthest) continue;
      farthest = beyond;
      found = {.joint = i, .q = q[i]};
    }
  }
  return found;
}

std::string describe(const BeyondServo& beyond, const Arm& arm) {
  const ArmJoint& joint = arm.joints[static_cast<std::size_t>(beyond.joint)];
  const ServoRange range = servo_range(joint);
  return text(msg::execution_beyond_servo, joint.name, beyond.q, joint.actuator->name, range.lower,
              range.upper);
}

}  // namespace mjarm
