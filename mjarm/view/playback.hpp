#pragma once

#include "mjarm/view/events.hpp"
#include "mjarm/view/real_time.hpp"

namespace mjarm::view {

/// How fast a simulation goes on, as the user of a window asks for it: pause, single steps, speed.
class Playback {
 public:
  /// @param timestep [s] of one physics step, > 0.
  explicit Playback(double timestep, bool paused = false);

  /// Follows an event of the window.
  /// @return false where the event is about something else; steps back are, too.
  bool handle(const ViewEvent& event);

  /// Steps to run now: those that are due while it runs, those asked for singly while it pauses.
  [[nodiscard]] int steps_due();
  /// The same with the clock given: `now` [s], from any fixed origin, never falling.
  [[nodiscard]] int steps_due_at(double now);

  void set_paused(bool paused) noexcept { paused_ = paused; }
  [[nodiscard]] bool paused() const noexcept { return paused_; }
  [[nodiscard]] double speed() const noexcept { return pacer_.speed(); }

 private:
  RealTimePacer pacer_;
  bool paused_;
  int asked_ = 0;  ///< single steps not yet run
};

}  // namespace mjarm::view
