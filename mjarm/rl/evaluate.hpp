#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/rl/policy.hpp"
#include "mjarm/rl/reach_options.hpp"
#include "mjarm/rl/vec_env.hpp"

namespace mjarm::rl {

/// How a policy is judged.
struct EvaluateOptions {
  int episodes = 200;      ///< each with a goal of its own, 1 to 100000
  std::uint64_t seed = 1;  ///< decides the goals; training never draws from the same streams
  /// Told again and again how many actions of how many at most are done, of all episodes together.
  /// May be empty.
  std::function<void(std::int64_t done, std::int64_t max)> progress = {};
  StopCheck stop = {};
};

/// What came of it. Distances are those at the end of an episode, when its time is over.
struct Evaluation {
  int episodes = 0;
  double within_5cm = 0;  ///< share of the episodes, 0 to 1
  double within_2cm = 0;
  double within_1cm = 0;
  double within_5mm = 0;
  double median = 0;        ///< [m]
  double p95 = 0;           ///< [m] 95 % of the episodes are at most so far away
  double max = 0;           ///< [m]
  double steps = 0;         ///< mean length of an episode, in actions
  double steps_to_2cm = 0;  ///< mean number of actions until the tool first was within 2 cm, of the
                            ///< episodes in which it was; 0 where it never was
  double turn_median =
      0;                ///< [rad] the tool's z axis from straight down; 0 where it does not count
  double turn_p95 = 0;  ///< [rad]
  double touched = 0;   ///< share of the episodes in which the arm touched something
  std::vector<double> distances;  ///< [m] one an episode, in the order of the goals; infinite where
                                  ///< the simulation failed
};

/// @return an error where the policy is none for the numbers of observations and actions.
[[nodiscard]] Result<void> check_sizes(const Policy& policy, const VecEnv& env);

/// Writes the actions, shape (rows, actions), for observations of shape (rows, observations).
using ActFunction =
    std::function<void(std::span<const float> observations, std::span<float> actions)>;

/// Runs every episode once, many of them at the same time, on goals that training has not seen. The
/// same for any number of threads. `options.environments` and `options.held_out` play no part.
/// @return an error where the environment cannot be made or an action is not a number; stopped()
/// where EvaluateOptions::stop ended the work.
[[nodiscard]] Result<Evaluation> evaluate(const Model& model, const ReachOptions& options,
                                          const ActFunction& act, const EvaluateOptions& how = {});

/// The same with the mean actions of a policy.
/// @return also an error where its sizes are not those of the task.
[[nodiscard]] Result<Evaluation> evaluate(const Model& model, const ReachOptions& options,
                                          const Policy& policy, const EvaluateOptions& how = {});

}  // namespace mjarm::rl
