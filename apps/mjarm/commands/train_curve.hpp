#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/render/plot.hpp"
#include "mjarm/rl/training.hpp"

namespace mjarm::app {

/// What came of one training.
struct TrainedSeed {
  rl::TrainingOptions options;
  std::int64_t steps = 0;
  std::optional<rl::Evaluation> best = {};
  double seconds = 0;     ///< [s] wall-clock time of this run, without evaluations
  bool advanced = false;  ///< by an iteration at least
  bool interrupted = false;
};

/// One line a seed; with several, the median of each column below.
[[nodiscard]] std::string seeds_table(const std::vector<TrainedSeed>& runs);

/// Success and return over steps, of the `progress.csv` in a folder.
[[nodiscard]] Result<render::Plot> curve_plot(const std::filesystem::path& folder);

/// Draws `curve.svg` and `curve.png` from the `progress.csv` in the same folder.
[[nodiscard]] Result<void> draw_curve(const std::filesystem::path& folder);

}  // namespace mjarm::app
