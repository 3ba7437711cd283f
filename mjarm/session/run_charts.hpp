#pragma once

#include <span>
#include <string>
#include <vector>

#include "mjarm/execution/measured_run.hpp"
#include "mjarm/execution/presser.hpp"
#include "mjarm/execution/report.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/render/plot.hpp"

namespace mjarm::session {

/// Single charts of a run; the tool speed [m/s], the distance to the curve [mm], joint values
/// [rad] with their limits, and joint speeds [rad/s] with the largest limit as a strip.
[[nodiscard]] render::PlotPanel front_panel(std::span<const MeasuredRun> runs);
[[nodiscard]] render::PlotPanel tool_speed_panel(std::span<const MeasuredRun> runs);
[[nodiscard]] render::PlotPanel error_panel(std::span<const MeasuredRun> runs, double tolerance);
[[nodiscard]] render::PlotPanel joint_panel(const Arm& arm, std::span<const MeasuredRun> runs);
[[nodiscard]] render::PlotPanel joint_speed_panel(const Arm& arm,
                                                  std::span<const MeasuredRun> runs);

/// What a run has to show.
struct RunRecord {
  std::span<const MeasuredRun> runs;
  std::span<const InkPoint> ink = {};  ///< of a tool that pressed on something
};

/// The page of motion_plot() with what its report says of the path at the foot. Of a tool that
/// pressed it shows the ink, how far that is off the strokes and the force, in the place of the
/// path and its errors.
/// @param name, control  that the report gets, or has.
[[nodiscard]] render::Plot run_plot(const std::string& name, const std::string& control,
                                    const Report& report, const Arm& arm, const RunRecord& record,
                                    double tolerance);

/// One page about a run: tool path from three sides (planned dashed, executed solid), tool speed,
/// error with its tolerance [m], joint values, worst use of velocity and torque limits.
[[nodiscard]] render::Plot motion_plot(const std::string& title, const Arm& arm,
                                       std::span<const MeasuredRun> runs, double tolerance);

}  // namespace mjarm::session
