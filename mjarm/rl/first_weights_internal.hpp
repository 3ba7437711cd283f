#pragma once

#include "mjarm/core/rng.hpp"
#include "mjarm/rl/policy.hpp"

namespace mjarm::rl::detail {

/// Draws the parameters before training: orthogonal weights (A. M. Saxe et al., arXiv:1312.6120)
/// with the gain sqrt(2) in hidden layers, 0.01 in the actor's last and 1 in the critic's last one;
/// biases 0.
void draw_first_weights(Policy& policy, double log_std, Rng& rng);

}  // namespace mjarm::rl::detail
