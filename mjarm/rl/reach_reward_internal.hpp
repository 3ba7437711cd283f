#pragma once

#include "mjarm/rl/reach_options.hpp"

namespace mjarm::rl {

/// What the reward of a step looks at.
struct ReachOutcome {
  double distance = 0;     ///< [m] of the tool from the goal
  double turn = 0;         ///< [rad] of the tool's z axis from straight down
  double mean_square = 0;  ///< of the actions, each -1 to 1
  bool touching = false;   ///< something of the arm touches
  double near_limits = 0;  ///< sum over the joints: 0 at the margin or farther, 1 at the limit
};

/// As ReachReward writes it.
/// @param turns  whether the turn counts.
[[nodiscard]] double reward_of(const ReachReward& weights, const ReachOutcome& outcome, bool turns);

}  // namespace mjarm::rl
