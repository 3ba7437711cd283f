#pragma once

#include <limits>

#include "mjarm/model/arm.hpp"

namespace mjarm {

/// Joint values at which a servo can be told to rest.
struct ServoRange {
  double lower = -std::numeric_limits<double>::infinity();  ///< [rad or m]
  double upper = std::numeric_limits<double>::infinity();   ///< [rad or m]
};

/// What the commands that the joint's position servo takes (ctrlrange) are as joint values, without
/// load; everything where it takes any, or the joint has no such servo.
[[nodiscard]] ServoRange servo_range(const ArmJoint& joint) noexcept;

}  // namespace mjarm
