#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "mjarm/trajectory/path_timing.hpp"

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

/// Limits of `dof` joints like those of a UR5e.
inline JointLimits plain_limits(Eigen::Index dof) {
  const JointVec one = JointVec::Ones(dof);
  return limits_of(3 * one, 5 * one, 100 * one);
}

/// The straight path through `waypoints` in time, which has to be possible.
inline Trajectory timed(const std::vector<JointVec>& waypoints, const JointLimits& limits,
                        bool jerk) {
  const auto motion = time_waypoint_path(waypoints, limits, {.jerk_limits = jerk});
  EXPECT_TRUE(motion.has_value()) << motion.error().what;
  return motion.value_or(Trajectory{});
}

}  // namespace mjarm::testing
