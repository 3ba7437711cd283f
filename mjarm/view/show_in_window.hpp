#pragma once

#include <functional>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/view/view_link.hpp"
#include "mjarm/view/view_stats.hpp"
#include "mjarm/view/window.hpp"

namespace mjarm::view {

/// How long a window stays.
struct ShowOptions {
  double seconds = 0;  ///< closes by itself after so long; 0 = never
  /// Called with the open window, before anything is drawn; may be empty.
  std::function<void(Window&)> on_open = {};
};

/// Opens a window and draws in it what `simulate` hands over, which runs in a thread of its own,
/// until the window is closed; then `simulate` has to return. Called from the main thread.
/// @return how it was drawn; impossible with a hint where there is no display.
[[nodiscard]] Result<ViewStats> show_in_window(const Model& model, const std::string& title,
                                               const WindowOptions& window,
                                               const ShowOptions& options,
                                               const std::function<void(ViewLink&)>& simulate);

}  // namespace mjarm::view
