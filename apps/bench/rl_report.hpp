#pragma once

#include <filesystem>
#include <vector>

#include "apps/bench/rl_run.hpp"

namespace mjarm::app {

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
