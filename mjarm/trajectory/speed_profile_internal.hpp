#pragma once

#include <vector>

#include "mjarm/trajectory/limits_internal.hpp"
#include "mjarm/trajectory/spline_internal.hpp"

namespace mjarm::detail {

/// A fine grid along a spline with what the joint limits need of it.
struct PathGrid {
  explicit PathGrid(const CubicSpline& spline);

  std::vector<double> s;    ///< ascending, start and end included
  std::vector<JointVec> d;  ///< dq/ds
  std::vector<JointVec> e;  ///< d2q/ds2
};

/// Bounds of the motion along the path itself.
struct PathBounds {
  double speed;         ///< [m/s] > 0
  double acceleration;  ///< [m/s^2] > 0
};

/// A motion along a path from rest to rest: acceleration constant between neighbours.
struct SpeedProfile {
  std::vector<double> t;  ///< [s] strictly ascending from 0
  std::vector<double> s;  ///< path parameter
  std::vector<double> v;  ///< ds/dt >= 0
  [[nodiscard]] double duration() const { return t.back(); }
};

/// The fastest motion along the grid with |dq/dt| and |d2q/dt2| within `bounds` at its points, by
/// one pass backward (from where each speed can still stop in time) and one forward (H. Pham and
/// Q.-C. Pham, IEEE T-RO 34 (2018) 645).
/// @param slow  factor in (0, 1] on the speeds at each grid point; accelerations go with its
/// square.
[[nodiscard]] SpeedProfile fastest_profile(const PathGrid& grid, const Bounds& bounds,
                                           const PathBounds& path_bounds,
                                           const std::vector<double>& slow);

}  // namespace mjarm::detail
