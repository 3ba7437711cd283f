#pragma once

#include "mjarm/trajectory/speed_profile_internal.hpp"

namespace mjarm::detail {

/// Where a path is at one time.
struct PathState {
  double s;  ///< path parameter
  double v;  ///< ds/dt
  double a;  ///< d2s/dt2
  double j;  ///< d3s/dt3
};

/// A speed profile averaged over a sliding window of time with a hat-shaped weight. So s is three
/// times continuously differentiable; speed and acceleration keep the bounds of the profile, as
/// means of what they were; the motion lasts one window longer.
class SmoothProfile {
 public:
  /// @param window  [s] > 0
  SmoothProfile(const SpeedProfile& profile, double window);

  [[nodiscard]] double duration() const { return profile_->duration() + window_; }
  /// State at `t` in [0, duration()].
  [[nodiscard]] PathState at(double t) const;

 private:
  [[nodiscard]] double speed_before(double t) const;
  void add_cell(PathState& sum, double from, double to, std::size_t cell, double end) const;

  const SpeedProfile* profile_;
  double window_;
};

}  // namespace mjarm::detail
