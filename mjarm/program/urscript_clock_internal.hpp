#pragma once

#include <vector>

#include "mjarm/model/arm.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm::program::detail {

/// When a tool motion passes each place of its curve, and how fast; sampled, good to about 1e-4.
class ToolClock {
 public:
  /// @param trajectory  of `arm` along all of `curve`.
  ToolClock(const Arm& arm, const Trajectory& trajectory, const Curve& curve);

  /// [s] when the tool passes parameter `s`.
  [[nodiscard]] double time_at(double s) const;
  /// [m/s], or [rad/s] in a turn on the spot: the greatest between two parameters.
  [[nodiscard]] double peak(double s_from, double s_to) const;
  /// [m/s] 0: it begins at rest.
  [[nodiscard]] double speed_at_start() const { return speed_.front(); }

 private:
  std::vector<double> t_, s_, speed_;
};

/// Speed and acceleration of a trapezoid over `way` in `seconds` that goes no faster than `peak`
/// where it can: the ramps take what is left of the time. Where the time is longer than two ramps
/// to `peak` need, one of two ramps without a stretch between them.
/// @param way      [m or rad] > 0
/// @param seconds  > 0
struct Trapezoid {
  double speed = 0;  ///< [per s]
  double accel = 0;  ///< [per s^2]
};
[[nodiscard]] Trapezoid trapezoid(double way, double seconds, double peak);

}  // namespace mjarm::program::detail
