#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/rl/policy.hpp"

namespace mjarm::rl {

/// How the learning rate changes over `total_steps`.
enum class Schedule {
  constant,
  linear,  ///< down to 0 at the last step
};
/// "constant" or "linear".
[[nodiscard]] std::string_view name(Schedule schedule) noexcept;

/// How to train by proximal policy optimisation (J. Schulman et al., arXiv:1707.06347). The
/// defaults suit some dozens of copies of a task of about 50 steps, such as reaching for a point.
struct PpoOptions {
  std::uint64_t seed = 1;             ///< of weights, actions, order of samples and environments
  int threads = 2;                    ///< >= 1; no result depends on it
  std::int64_t total_steps = 200000;  ///< steps of all copies, > 0; where the schedule ends

  int rollout_steps = 32;  ///< of every copy between two updates, > 0
  int minibatch = 256;     ///< samples a gradient step, about (minibatches are of equal size), >= 2
  int epochs = 6;          ///< how often each sample is used, > 0

  double learning_rate = 1e-3;  ///< of Adam, > 0
  Schedule schedule = Schedule::linear;
  double adam_epsilon = 1e-5;        ///< > 0
  double max_gradient_norm = 0.5;    ///< longer gradients are scaled down to it; 0: no limit
  double discount = 0.95;            ///< of a reward one step later, in [0, 1]
  double gae_lambda = 0.95;          ///< in [0, 1]: 0 trusts the critic alone, 1 the rewards alone
  double clip = 0.2;                 ///< of the ratio of probabilities, > 0
  double value_clip = 0;             ///< of a value's change in one update, > 0; 0: no limit
  double value_weight = 0.5;         ///< of the critic's loss, >= 0
  double entropy_weight = 0;         ///< of the entropy bonus, >= 0
  double target_kl = 0;              ///< an update ends beyond 1.5 times this divergence; 0: never
  bool normalise_advantages = true;  ///< to mean 0 and deviation 1, in each minibatch
  bool normalise_observations = true;  ///< by their running mean and variance
  bool scale_rewards = false;          ///< by the running deviation of the discounted return

  std::vector<int> actor = {256, 256};   ///< hidden layers, each > 0
  std::vector<int> critic = {256, 256};  ///< hidden layers, each > 0
  Activation activation = Activation::tanh;
  double initial_log_std = -0.7;  ///< logarithm of the actions' deviation at the start, in [-20, 2]
};

/// @return an error that names the first option out of its range, its value and the range.
[[nodiscard]] Result<void> check(const PpoOptions& options);

}  // namespace mjarm::rl
