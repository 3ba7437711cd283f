#pragma once

#include <optional>

namespace mjarm::view {

/// Tells how many physics steps are due so that simulated time keeps up with the clock on the wall.
/// The only place that looks at that clock; results never depend on it.
class RealTimePacer {
 public:
  /// @param timestep [s] of one physics step, > 0.
  /// @param speed simulated seconds a second, > 0; 1 = real time.
  explicit RealTimePacer(double timestep, double speed = 1);

  /// Steps to run now. Time spent paused does not count; after a hiccup at most 0.25 s of the clock
  /// is caught up at once, so that a window stays alive on a slow machine.
  [[nodiscard]] int steps_due(bool paused = false);
  /// The same with the clock given: `now` [s], from any fixed origin, never falling.
  [[nodiscard]] int steps_due_at(double now, bool paused = false);

  /// @param speed simulated seconds a second from now on, > 0.
  void set_speed(double speed);
  [[nodiscard]] double speed() const noexcept { return speed_; }

 private:
  double timestep_;
  double speed_;
  double owed_ = 0;             ///< [s] simulated time that is due and not yet run
  std::optional<double> last_;  ///< [s] time of the call before
};

}  // namespace mjarm::view
