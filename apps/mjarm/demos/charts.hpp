#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mjarm/model/arm.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/program/metrics.hpp"
#include "mjarm/render/plot.hpp"
#include "mjarm/sim/recorder.hpp"

namespace mjarm::app {

/// A part of a run that was measured against a curve, or against nothing but the plan.
struct MeasuredRun {
  std::vector<RecordRow> rows;
  const Curve* curve = nullptr;         ///< null = errors are from planned to executed tool
  std::optional<PathError> error = {};  ///< against `curve`
};

/// Single charts of a run; the tool speed [m/s], the distance to the curve [mm], joint values
/// [rad] with their limits, and joint speeds [rad/s] with the largest limit as a strip.
[[nodiscard]] PlotPanel front_panel(std::span<const MeasuredRun> runs);
[[nodiscard]] PlotPanel tool_speed_panel(std::span<const MeasuredRun> runs);
[[nodiscard]] PlotPanel error_panel(std::span<const MeasuredRun> runs, double tolerance);
[[nodiscard]] PlotPanel joint_panel(const Arm& arm, std::span<const MeasuredRun> runs);
[[nodiscard]] PlotPanel joint_speed_panel(const Arm& arm, std::span<const MeasuredRun> runs);

/// One page about a run: tool path from three sides (planned dashed, executed solid), tool speed,
/// error with its tolerance [m], joint values, worst use of velocity and torque limits.
[[nodiscard]] Plot motion_plot(const std::string& title, const Arm& arm,
                               std::span<const MeasuredRun> runs, double tolerance);

}  // namespace mjarm::app
