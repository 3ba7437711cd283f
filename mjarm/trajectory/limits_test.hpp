#pragma once

#include <limits>

#include "mjarm/model/arm.hpp"

namespace mjarm::testing {

/// Limits of velocity, acceleration and jerk alone.
inline JointLimits limits_of(const JointVec& v, const JointVec& a, const JointVec& j) {
  const JointVec far = JointVec::Constant(v.size(), std::numeric_limits<double>::infinity());
  return {.lower = -far,
          .upper = far,
          .velocity = v,
          .acceleration = a,
          .jerk = j,
          .torque = far,
          .sources = {}};
}

}  // namespace mjarm::testing
