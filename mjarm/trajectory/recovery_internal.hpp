#pragma once

#include <array>

#include "mjarm/trajectory/extremal_internal.hpp"

namespace mjarm::detail {

/// From a start beyond a limit, or that must overshoot one, back within the limits as fast as the
/// jerk and acceleration limits allow. Nothing to do for any other start.
struct Recovery {
  explicit Recovery(const OneJoint& joint) noexcept;

  std::array<JerkPhase, 3> phases{};
  double v, a;          ///< [rad/s], [rad/s^2] after it
  double way = 0;       ///< [rad] travelled
  double duration = 0;  ///< [s]

 private:
  void add(double duration, double jerk) noexcept;
  void slow_down(const OneJoint& joint, double sign) noexcept;
  std::size_t count_ = 0;
};

/// Share of a limit that rounding may break.
inline constexpr double kLimitSlack = 1e-12;

}  // namespace mjarm::detail
