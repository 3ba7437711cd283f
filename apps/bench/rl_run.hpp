#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "apps/bench/report.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/rl/training.hpp"

namespace mjarm::app {

/// A task on which learners are compared.
struct LearningSet {
  std::string name;             ///< "tutorial", "as_model" or "wide"
  rl::TrainingOptions options;  ///< of every learner; seeds count up from its own
  int peer_seeds = 0;           ///< with how many seeds peers learn it at most
};

/// The tutorial's region with the gripper held open; a short one with the gripper as the model has
/// it, for the rate; and the wide region.
[[nodiscard]] std::vector<LearningSet> learning_sets();

/// How good a policy was at some time of its training.
struct LearningPoint {
  std::int64_t steps = 0;
  double seconds = 0;                  ///< [s] of training so far, without evaluations
  std::vector<double> distances = {};  ///< [m] at the end of an episode, one an unseen goal
};
/// Share of the goals, 0 to 1, that ended within `distance` [m].
[[nodiscard]] double share_within(const LearningPoint& point, double distance);

/// What one learner did on one set with one seed.
struct LearningRun : BenchEntry {
  std::uint64_t seed = 0;
  std::vector<LearningPoint> curve = {};
};

/// Told of so many more steps; false stops the work.
using AdvanceSteps = std::function<bool(std::uint64_t steps)>;

/// Trains by mjarm.
/// @param folder  exists; gets the files of the training.
/// @return also an error where it was stopped.
[[nodiscard]] Result<LearningRun> run_learner(const Model& model, const LearningSet& set,
                                              std::uint64_t seed,
                                              const std::filesystem::path& folder,
                                              const AdvanceSteps& advance);

}  // namespace mjarm::app
