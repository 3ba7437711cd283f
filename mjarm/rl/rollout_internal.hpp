#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/rl/networks_internal.hpp"
#include "mjarm/rl/policy.hpp"
#include "mjarm/rl/vec_env.hpp"

namespace mjarm::rl::detail {

/// The episodes that run when a rollout ends, one a copy.
struct OpenEpisodes {
  std::vector<double> returns;        ///< rewards so far
  std::vector<double> discounted;     ///< the same, older ones discounted
  std::vector<std::int64_t> lengths;  ///< steps so far

  explicit OpenEpisodes(int copies)
      : returns(static_cast<std::size_t>(copies)),
        discounted(returns.size()),
        lengths(returns.size()) {}
};

/// What all copies of an environment do in some steps, ordered as Experience is: step by step, copy
/// by copy.
struct Rollout {
  int steps = 0, copies = 0;
  std::vector<float> observations;  ///< (steps + 1, copies, observations), as the task gives them
  std::vector<float> actions;       ///< (steps, copies, actions), not clamped
  std::vector<float> log_probs, rewards;            ///< (steps, copies)
  std::vector<std::uint8_t> terminated, truncated;  ///< (steps, copies)
  std::vector<std::size_t> cut;                     ///< places in the latter of truncated episodes
  std::vector<float> final_observations;            ///< (cut, observations), where they ended
  std::int64_t ended = 0;                           ///< episodes
  double ended_returns = 0;                         ///< sum over them
  double ended_steps = 0;                           ///< sum over them

  Rollout(int steps, int copies, const PolicyShape& shape);
  [[nodiscard]] std::size_t samples() const noexcept { return rewards.size(); }
};

/// Fills `out` with the next steps of the environment under the policy, which `networks` is packed
/// with; actions are drawn with `rng`.
/// @return what the environment says, or an error that names a number that is not finite.
[[nodiscard]] Result<void> collect(VecEnv& env, const Policy& policy, Networks& networks, Rng& rng,
                                   OpenEpisodes& open, Rollout& out);

/// Computes the logarithms of the probabilities of all actions anew, for a normaliser that was not
/// known when they were taken.
void update_log_probs(const Policy& policy, Networks& networks, Rollout& rollout);

/// Divides the rewards by the deviation of the discounted return, which `scale` (of one number)
/// follows; all ranks take part.
void scale_rewards(double discount, Normaliser& scale, OpenEpisodes& open, Rollout& rollout,
                   Ranks* ranks);

}  // namespace mjarm::rl::detail
