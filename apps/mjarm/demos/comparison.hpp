#pragma once

#include <span>
#include <string>

#include "mjarm/model/arm.hpp"
#include "mjarm/render/plot.hpp"
#include "mjarm/session/run_charts.hpp"

namespace mjarm::app {

/// The fastest joint of a run.
struct PeakSpeed {
  double speed = 0;  ///< [rad/s or m/s] measured
  int joint = 0;     ///< index in the arm
};
[[nodiscard]] PeakSpeed peak_speed(const MeasuredRun& run);

/// Largest distance [m] of the tool from the run's curve, which must be set.
[[nodiscard]] double largest_distance(const MeasuredRun& run);

/// What a page of runs shows, one row each.
enum class Chart { joint_speeds, joints, front, tool_speed, error };

struct ComparisonText {
  std::string title;
  std::string note;  ///< what came out, at the foot of the page
};

/// One way to do it.
struct ComparedRun {
  std::string title;
  MeasuredRun run;
};

/// Runs side by side, in axes of the same scale, time counted from the beginning of each.
[[nodiscard]] render::Plot comparison_plot(const ComparisonText& about, const Arm& arm,
                                           std::span<const ComparedRun> runs,
                                           std::span<const Chart> rows);

}  // namespace mjarm::app
