#pragma once

#include "apps/mjarm/demos/stage.hpp"
#include "apps/mjarm/program_load.hpp"

namespace mjarm::app {

/// Moves the arm along a whole plan, from its beginning; the reference rests `settle` [s] at the
/// end. Approaches are not part of what is measured.
[[nodiscard]] Result<void> execute(Stage& stage, const ProgramPlan& plan, ControlMode mode,
                                   double settle);

/// Runs a plan without faults by the control the user or the program chose, with a progress bar,
/// and writes its files; `ok` is withdrawn where a curve was left by more than `tolerance` [m].
[[nodiscard]] Result<Report> run_plan(Stage& stage, const LoadedProgram& loaded, double tolerance);

}  // namespace mjarm::app
