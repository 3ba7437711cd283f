#include <cmath>

#include "mjarm/rl/reach_reward_internal.hpp"

namespace mjarm::rl {

double reward_of(const ReachReward& weights, const ReachOutcome& outcome, bool turns) {
  const double d = outcome.distance;
  double reward = weights.coarse * std::exp(-d / weights.coarse_scale) +
                  weights.fine * std::exp(-d / weights.fine_scale) - weights.distance * d -
                  weights.action * outcome.mean_square -
                  (outcome.touching ? weights.collision : 0) - weights.limit * outcome.near_limits;
  if (turns) {
    reward += weights.turn_fine * std::exp(-outcome.turn / weights.turn_scale) -
              weights.turn * outcome.turn;
  }
  return reward;
}

}  // namespace mjarm::rl
