#pragma once

#include <array>
#include <cstddef>
#include <vector>

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
/// means of what they were; the motion lasts one window longer. A state takes a time in proportion
/// to the logarithm of the number of cells.
class SmoothProfile {
 public:
  /// @param window  [s] > 0
  SmoothProfile(const SpeedProfile& profile, double window);

  [[nodiscard]] double duration() const { return profile_->duration() + window_; }
  /// State at `t` in [0, duration()].
  [[nodiscard]] PathState at(double t) const;

 private:
  /// Integrals of f and of f times the time since the start of the range, for f = s (from the
  /// start of the path), v and a.
  struct Moments {
    std::array<double, 3> plain{}, timed{};

    void add(const Moments& part, double later);
  };

  [[nodiscard]] double speed_before(double t) const;
  [[nodiscard]] std::size_t cell_at(double t) const;
  [[nodiscard]] Moments within_cell(std::size_t cell, double from, double to) const;
  [[nodiscard]] Moments over(double from, double to) const;

  const SpeedProfile* profile_;
  double window_;
  // Level k has the moments of 2^k cells at a time, so that a sum of any run of cells has few
  // terms and none larger than itself: differences of sums from the start would lose digits.
  std::vector<std::vector<Moments>> levels_;
};

}  // namespace mjarm::detail
