#pragma once

#include <string>

#include "apps/mjarm/view/view_show.hpp"
#include "mjarm/program/load_program.hpp"

namespace mjarm::app {

/// Plans a program and opens a window in which the user runs it.
/// @return the exit code, or the same error as `mjarm run`.
[[nodiscard]] Result<int> view_program(const std::string& name_or_path, WindowOptions window,
                                       const ShowOptions& options);

/// The same window for a plan without faults, which runs at once; for work beside windows
/// (`run_beside_windows`). Returns when the window is gone, at once where there is none to be had.
/// @param seconds  [s] of simulated time after which it stops; 0 = it goes on to its end.
[[nodiscard]] Result<void> show_program(const LoadedProgram& loaded, double seconds);

}  // namespace mjarm::app
