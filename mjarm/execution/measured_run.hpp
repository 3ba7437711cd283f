#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mjarm/execution/metrics.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/sim/recorder.hpp"

namespace mjarm {

/// A stretch of a record that is to be measured.
struct MeasuredSpan {
  std::optional<Curve> curve = {};  ///< that the tool was to follow; none = it is only looked at
  double from = 0;                  ///< [s]
  double to = 0;                    ///< [s]
  Pose X_TU = {};  ///< the frame that was to be on the curve, in the recorded arm's tool frame
};

/// A part of a run that was measured against a curve, or against nothing but the plan.
struct MeasuredRun {
  std::vector<RecordRow> rows;          ///< poses are of the frame that was to be on the curve
  const Curve* curve = nullptr;         ///< null = errors are from planned to executed tool
  std::optional<PathError> error = {};  ///< against `curve`
};

/// What was recorded in each of `spans`, which follow each other in time; the curves point into
/// them.
[[nodiscard]] std::vector<MeasuredRun> measured_runs(const Recorder& recorder,
                                                     std::span<const MeasuredSpan> spans);

/// The errors of all runs that have a curve, together; none where no row was measured. `coverage`
/// is of the curves' whole length.
[[nodiscard]] std::optional<PathError> path_error(std::span<const MeasuredRun> runs);

/// [m/s] The largest speed of the tool on runs that have a curve; none where none has.
[[nodiscard]] std::optional<double> max_tool_speed(std::span<const MeasuredRun> runs);

}  // namespace mjarm
