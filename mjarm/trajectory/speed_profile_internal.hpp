#pragma once

#include <cstddef>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/trajectory/limits_internal.hpp"
#include "mjarm/trajectory/spline_internal.hpp"

namespace mjarm::detail {

/// Bounds of the motion along the path itself; infinite where there are none.
struct PathBounds {
  double speed;                          ///< [m/s] > 0
  double acceleration;                   ///< [m/s^2] > 0
  double jerk;                           ///< [m/s^3] > 0
  const TimingOptions* asked = nullptr;  ///< given: the speed is what it says for the place

  [[nodiscard]] double speed_at(double s) const {
    return asked == nullptr ? speed : asked->speed_at(s);
  }
};

/// A motion along a path from rest to rest on a grid that has all waypoints in it. Between
/// neighbours the acceleration is linear in time; it may jump at the grid points.
struct SpeedProfile {
  std::vector<double> t;         ///< [s] strictly ascending from 0
  std::vector<double> s;         ///< path parameter
  std::vector<double> v;         ///< ds/dt >= 0
  std::vector<double> a_before;  ///< d2s/dt2 at the end of the cell before each grid point
  std::vector<double> a_after;   ///< and at the start of the one after it
  [[nodiscard]] double duration() const { return t.back(); }
};

/// The fastest motion along `spline` with |dq/dt|, |d2q/dt2| and torques within `bounds`, by one
/// pass backward (from where each speed can still stop in time) and one forward (H. Pham and Q.-C.
/// Pham, IEEE T-RO 34 (2018) 645). Unlike there the acceleration may change within a cell, so that
/// the error falls with the square of the cells' size. Bounds hold at the grid points, and in
/// between to about one part in a thousand or better.
/// @param cells  at least so many, and two between waypoints.
/// @return an error where torque limits leave nothing to move with; else always a motion.
[[nodiscard]] Result<SpeedProfile> fastest_profile(const CubicSpline& spline, std::size_t cells,
                                                   const Bounds& bounds,
                                                   const PathBounds& path_bounds);

}  // namespace mjarm::detail
