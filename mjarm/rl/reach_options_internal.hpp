#pragma once

#include <Eigen/Core>

#include "mjarm/rl/reach_options.hpp"

namespace mjarm::rl {

/// Whether the numbers are in their ranges and fit together; the error names the option.
[[nodiscard]] Result<void> check(const ReachOptions& options);

/// The point that is to be at the goal, in the tool frame [m]: its origin. The tutorial measures at
/// a point 0.105 m out of the hand, `hand_tcp` lies 0.1034 m out.
[[nodiscard]] inline Eigen::Vector3d judged_point(const ReachOptions& options) {
  return {0, 0, options.guide ? 0.105 - 0.1034 : 0};
}

}  // namespace mjarm::rl
