#pragma once

#include <numeric>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/rl/adam_internal.hpp"
#include "mjarm/rl/networks_internal.hpp"
#include "mjarm/rl/ppo_gradient_internal.hpp"
#include "mjarm/rl/ppo_trainer.hpp"
#include "mjarm/rl/rollout_internal.hpp"
#include "mjarm/rl/workers_internal.hpp"

namespace mjarm::rl {

/// What a trainer holds. The first group decides what comes next and stands in checkpoints.
struct PpoTrainer::State {
  VecEnv& env;
  Policy policy;
  detail::Adam adam;
  Rng rng;  ///< of actions and of the order of samples
  Normaliser reward_scale;
  detail::OpenEpisodes open;
  std::int64_t steps = 0, iterations = 0;

  PpoOptions options;
  Ranks* ranks;
  detail::Workers workers;
  detail::Networks networks;
  detail::PpoGradient gradient;
  detail::Rollout rollout;

  State(VecEnv& environment, const PpoOptions& all_options, Ranks* all_ranks, Policy first_policy);

  /// Numbers that learning needs besides the rollout, of each of its samples.
  struct Targets {
    std::vector<float> observations;  ///< normalised
    std::vector<float> values, advantages, returns;
    double explained_variance = 0;
  };

  /// Sums over all ranks, in place.
  void sum_over_ranks(std::span<double> values) const;
  [[nodiscard]] int rank_count() const { return ranks == nullptr ? 1 : ranks->size(); }

  /// Fills the rollout; the counts of episodes go into the report.
  [[nodiscard]] Result<void> collect_rollout(IterationReport& report);
  [[nodiscard]] Targets targets();
  /// All epochs over the rollout.
  [[nodiscard]] Result<void> update(const Targets& targets, IterationReport& report);
  /// One minibatch.
  /// @return false where the divergence from the policy that collected is too large: nothing was
  ///         changed; an error where anything is not finite.
  [[nodiscard]] Result<bool> step(const detail::Samples& samples, std::span<const int> which,
                                  double rate, detail::LossMeans& losses, double& norm);
};

}  // namespace mjarm::rl
