#pragma once

#include <functional>

#include "apps/mjarm/demos/stage.hpp"
#include "apps/mjarm/commands/program_load.hpp"

namespace mjarm::app {

/// Calls `drive` for every motion of a plan that takes time, and for the last one, in order; the
/// gripper is told before what it has to do meanwhile.
/// @param settle  [s] rest after the last motion; `drive` gets how long to rest after each.
[[nodiscard]] Result<void> for_each_motion(
    const ProgramPlan& plan, Sim& sim, double settle,
    const std::function<Result<void>(const PlannedMove& move, double rest)>& drive);

/// Moves the arm along a whole plan, from its beginning; the reference rests `settle` [s] at the
/// end. Approaches are not part of what is measured.
[[nodiscard]] Result<void> execute(Stage& stage, const ProgramPlan& plan, ControlMode mode,
                                   double settle);

/// Runs a plan without faults by the control the user or the program chose, with a progress bar,
/// and writes its files; `ok` is withdrawn where a curve was left by more than `tolerance` [m].
/// @param begun  what is known already.
[[nodiscard]] Result<Report> run_plan(Stage& stage, const LoadedProgram& loaded, double tolerance,
                                      Report begun = {});

/// The same with a stage of its own, out of sight, since nobody could look as fast as that; then
/// `show_program`, unless there is to be no window.
/// @param camera  of the picture at the end, where the model has it.
[[nodiscard]] Result<Report> run_and_show(const LoadedProgram& loaded, const DemoOptions& options,
                                          double tolerance, const std::string& camera = "overview");

/// Options for a stage that nobody looks at.
[[nodiscard]] DemoOptions out_of_sight(DemoOptions options);

}  // namespace mjarm::app
