#pragma once

#include "mjarm/program/load_program.hpp"
#include "mjarm/session/stage.hpp"

namespace mjarm::app {

/// Runs a plan without faults by the control the user or the program chose, with a progress bar,
/// and writes its files; `ok` is withdrawn where a curve was left by more than `tolerance` [m].
/// @param begun  what is known already.
[[nodiscard]] Result<Report> run_plan(session::Stage& stage, const program::LoadedProgram& loaded,
                                      double tolerance, Report begun = {});

/// The same with a stage of its own, out of sight, since nobody could look as fast as that; then
/// `session::show_program`, unless there is to be no window.
[[nodiscard]] Result<Report> run_and_show(const program::LoadedProgram& loaded,
                                          const session::StageOptions& options, double tolerance);

/// Options for a stage that nobody looks at.
[[nodiscard]] session::StageOptions out_of_sight(session::StageOptions options);

}  // namespace mjarm::app
