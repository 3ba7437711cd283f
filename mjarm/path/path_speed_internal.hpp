#pragma once

#include "mjarm/core/pose.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm::detail {

/// Time [s] from pose to pose at a tool speed [m/s] (turns on the spot: [rad/s]) > 0.
[[nodiscard]] double time_at_speed(const Pose& X_before, const Pose& X_WT, double tool_speed);

/// Longest step of each joint in that time, with room for rounding.
[[nodiscard]] JointVec longest_at_speed(const Arm& arm, const Pose& X_before, const Pose& X_WT,
                                        double tool_speed);

/// The joint that would exceed its velocity limit by the largest factor.
struct Overspeed {
  int joint = -1;     ///< none where all keep their limits
  double amount = 0;  ///< [rad/s or m/s] beyond the limit
};

/// @param step  [rad or m] of each joint within `time` [s] >= 0.
[[nodiscard]] Overspeed overspeed(const Arm& arm, const JointVec& step, double time);

}  // namespace mjarm::detail
