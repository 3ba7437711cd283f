#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/bench/suite.hpp"
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

/// How good a policy was at some time of its training.
struct LearningPoint {
  std::int64_t steps = 0;
  double seconds = 0;                  ///< [s] of training so far, without evaluations
  std::vector<double> distances = {};  ///< [m] at the end of an episode, one an unseen goal
};

/// What one learner did on one set with one seed.
struct LearningRun : BenchEntry {
  std::uint64_t seed = 0;
  std::vector<LearningPoint> curve = {};
};

/// Lets the peers in a Python environment learn one set with one seed, on goals drawn by ours and
/// judged on the same unseen ones. Each first has to show that its environment does what ours does.
/// @return one run a peer, see run_peers().
[[nodiscard]] Result<std::vector<LearningRun>> run_learning_peers(
    const Model& model, const LearningSet& set, std::uint64_t seed,
    const std::filesystem::path& environment);

/// Headings of `BenchEntry::cells`.
[[nodiscard]] std::vector<Msg> learning_columns();

/// One entry a learner and set, over all seeds: after how many steps and seconds enough goals were
/// reached, and how many in the end. A run that failed is an entry of its own.
[[nodiscard]] std::vector<BenchEntry> learning_entries(const std::vector<LearningRun>& runs,
                                                       bool timing);

/// Draws `curves.svg` and `curves.png`: for each set and distance, the share of unseen goals over
/// the time of training (over the steps where `timing` is false), one line a seed.
[[nodiscard]] Result<void> draw_learning_curves(const std::vector<LearningRun>& runs, bool timing,
                                                const std::filesystem::path& folder);

}  // namespace mjarm::app
