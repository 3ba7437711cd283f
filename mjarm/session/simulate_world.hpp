#pragma once

#include <chrono>
#include <thread>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/render/fonts.hpp"
#include "mjarm/view/view_link.hpp"

namespace mjarm::session {

/// Lets `world` keep real time and do what the user asks for, until `link` is closed. Runs in a
/// thread of its own beside the one that draws: a slow picture never slows the simulation. A world
/// has
///
///     void handle(const ViewEvent& event);  // what the user did
///     int steps_due();                      // time steps to make now
///     void step();                          // one of them
///     void fill(ViewFrame& frame);          // what there is to be seen
///     bool take_drags();                    // optional: whether something was dragged
///
/// @param words  language of what the frames say; a page has the fonts for any, a window may not.
template <class World>
void simulate_world(World& world, view::ViewLink& link,
                    Language words = render::picture_language()) {
  view::ViewFrame frame;
  bool changed = true;
  const auto offer = [&] {
    if (!changed || !link.frames.is_empty()) return;
    changed = false;
    const LanguageScope drawn(words);
    world.fill(frame);
    link.frames.post(frame);
  };
  while (!link.closed) {
    for (const view::ViewEvent& event : link.events.take()) {
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

}  // namespace mjarm::session
