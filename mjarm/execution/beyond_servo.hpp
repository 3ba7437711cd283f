#pragma once

#include <optional>
#include <string>

#include "mjarm/model/arm.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm {

/// A joint that a motion leads where its servo takes no command, so that it cannot follow.
struct BeyondServo {
  int joint = -1;  ///< index in the arm
  double q = 0;    ///< [rad or m] the farthest that it is led
};

/// The joint that is led farthest beyond what its servo can be told (servo_range()), looked at
/// every hundredth of a second; none where all are within a hundredth of a radian or meter.
[[nodiscard]] std::optional<BeyondServo> beyond_servo(const Arm& arm, const Trajectory& motion);

/// One line, with what would mend it.
[[nodiscard]] std::string describe(const BeyondServo& beyond, const Arm& arm);

}  // namespace mjarm
