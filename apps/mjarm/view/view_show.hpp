#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include "mjarm/core/result.hpp"
#include "mjarm/view/view_link.hpp"

namespace mjarm::app {

/// How long a window stays, and what is told of it.
struct ShowOptions {
  double seconds = 0;  ///< closes by itself after so long; 0 = never
  bool stats = false;  ///< prints frames a second and the like at the end
  /// Called with the open window, before anything is drawn; may be empty.
  std::function<void(Window&)> on_open = {};
};

/// Opens a window and draws in it what `simulate` hands over, which runs in a thread of its own,
/// until the window is closed; then `simulate` has to return. Called from the main thread.
/// @return the exit code; impossible with a hint where there is no display.
[[nodiscard]] Result<int> show_in_window(const Model& model, const std::string& title,
                                         const WindowOptions& window, const ShowOptions& options,
                                         const std::function<void(ViewLink&)>& simulate);

/// Lets `world` keep real time and do what the user asks for, until the window is gone. A world
/// with something to be dragged has `take_drags` besides, which tells whether it was.
template <class World>
void simulate_world(World& world, ViewLink& link) {
  ViewFrame frame;
  bool changed = true;
  const auto offer = [&] {
    if (!changed || !link.frames.is_empty()) return;
    changed = false;
    world.fill(frame);
    link.frames.post(frame);
  };
  while (!link.closed) {
    for (const ViewEvent& event : link.events.take()) {
      world.handle(event);
      changed = true;
    }
    if constexpr (requires { world.take_drags(); }) {
      if (world.take_drags()) changed = true;
    }
    for (int due = world.steps_due(); due > 0 && !link.closed; --due) {
      world.step();
      changed = true;
      offer();
    }
    offer();
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
}

}  // namespace mjarm::app
