#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/render/overlay.hpp"
#include "mjarm/sim/sim.hpp"
#include "mjarm/view/events.hpp"
#include "mjarm/view/live_plot.hpp"
#include "mjarm/view/mailbox.hpp"
#include "mjarm/view/panel_section.hpp"

namespace mjarm::view {

class Window;

/// All that one frame of a window shows.
struct ViewFrame {
  Snapshot snapshot = {};
  render::Overlay overlay = {};
  std::vector<LivePlot> plots = {};
  std::vector<PanelSection> panels = {};
  std::string status = {};  ///< see `Window::set_status`
};

/// What passes between the thread that simulates and the main thread, which draws. Neither waits
/// for the other: a slow picture never slows the simulation.
struct ViewLink {
  Mailbox<ViewFrame> frames;        ///< to the window
  Queue<ViewEvent> events;          ///< from the window
  std::atomic<bool> closed{false};  ///< the window is gone
};

/// Draws what comes through `link`, and sends back what the user does, until the window is closed
/// or `ended()` holds; then `link.closed` is set. Called from the main thread.
/// @return system where the display was lost.
[[nodiscard]] Result<void> draw_until_closed(Window& window, ViewLink& link,
                                             const std::function<bool()>& ended);

}  // namespace mjarm::view
