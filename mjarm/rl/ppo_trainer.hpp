#pragma once

#include <cstdint>
#include <memory>

#include "mjarm/core/ranks.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/rl/policy.hpp"
#include "mjarm/rl/ppo.hpp"
#include "mjarm/rl/tensor_set.hpp"
#include "mjarm/rl/vec_env.hpp"

namespace mjarm::rl {

/// What one iteration (a rollout and an update) did. Losses and the like are means over all
/// minibatches of the update; with several ranks all but the times and `explained_variance` is of
/// all of them.
struct IterationReport {
  std::int64_t iteration = 0;  ///< from 1
  std::int64_t steps = 0;      ///< of all copies since the start of the training
  std::int64_t episodes = 0;   ///< that ended in this rollout
  double mean_return = 0;      ///< sum of rewards of such an episode; 0 where none ended
  double mean_length = 0;      ///< steps of such an episode; 0 where none ended

  double policy_loss = 0;
  double value_loss = 0;          ///< mean squared error, not weighted
  double entropy = 0;             ///< [nat] of the actions
  double kl = 0;                  ///< [nat] about how far the policy had moved in the last epoch
  double clip_fraction = 0;       ///< share of samples whose ratio was clipped
  double explained_variance = 0;  ///< of the returns by the critic, before the update; at best 1
  double gradient_norm = 0;       ///< before it is clipped
  double learning_rate = 0;
  double mean_std = 0;  ///< of the actions, after the update
  int epochs = 0;       ///< begun, fewer than asked for where the divergence stopped them

  double collect_us = 0;  ///< wall-clock time of the rollout
  double update_us = 0;   ///< wall-clock time of the rest
};

/// Trains a policy on an environment. The same options, environment and seed give the same bytes,
/// whatever the number of threads.
class PpoTrainer {
 public:
  /// Resets the environment and draws the first weights.
  /// @param env    must outlive the trainer, which alone may step it.
  /// @param ranks  must outlive the trainer; null: this process alone. All ranks have the same
  ///               options; their environments and random numbers differ by the rank.
  /// @return an error where an option is out of range, or the environment fails.
  [[nodiscard]] static Result<PpoTrainer> create(VecEnv& env, const PpoOptions& options,
                                                 Ranks* ranks = nullptr);
  ~PpoTrainer();
  PpoTrainer(PpoTrainer&& other) noexcept;
  PpoTrainer& operator=(PpoTrainer&& other) noexcept;

  /// Collects one rollout of `rollout_steps * env.count()` steps and learns from it.
  /// @return an error that names the iteration where the environment fails, an observation or a
  ///         reward is not finite, or the losses or gradients are not. The policy is then what it
  ///         was before; going on needs `restore`.
  [[nodiscard]] Result<IterationReport> iterate();

  /// As it is after the last iteration.
  [[nodiscard]] const Policy& policy() const noexcept;
  [[nodiscard]] const PpoOptions& options() const noexcept;
  [[nodiscard]] std::int64_t steps() const noexcept;       ///< of all copies and ranks so far
  [[nodiscard]] std::int64_t iterations() const noexcept;  ///< so far

  /// Everything that decides what comes next, the policy and the environment included; of this
  /// rank.
  [[nodiscard]] TensorSet checkpoint() const;
  /// Goes on where a trainer with the same environment and layers stood: with the same options, to
  /// the last bit as if it had never stopped. Options may differ otherwise.
  /// @return an error that names the tensor that is missing or does not fit; the trainer is then
  ///         what it was before, unless the environment itself refused its state.
  [[nodiscard]] Result<void> restore(const TensorSet& set);

 private:
  struct State;
  explicit PpoTrainer(std::unique_ptr<State> state) noexcept;
  std::unique_ptr<State> state_;
};

}  // namespace mjarm::rl
