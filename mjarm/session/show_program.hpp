#pragma once

#include "mjarm/program/load_program.hpp"
#include "mjarm/view/show_in_window.hpp"

namespace mjarm::session {

/// Opens a window in which the user runs a plan without faults. Called from the main thread.
/// @return how it was drawn; impossible with a hint where there is no display.
[[nodiscard]] Result<view::ViewStats> view_program(const program::LoadedProgram& loaded,
                                                   view::WindowOptions window,
                                                   const view::ShowOptions& options);

/// The same window, in which it runs at once; for work beside windows
/// (`run_beside_windows`). Returns when the window is gone, at once where there is none to be had.
/// @param seconds  [s] of simulated time after which it stops; 0 = it goes on to its end.
[[nodiscard]] Result<void> show_program(const program::LoadedProgram& loaded, double seconds);

}  // namespace mjarm::session
