#pragma once

#include "mjarm/trajectory/limits_internal.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm::detail {

/// Largest use of each kind of bound over a whole trajectory, as a share of it.
struct Peaks {
  double v = 0;
  double a = 0;
  double j = 0;
  /// By which factor the time has to be stretched to bring every use that counts to 1; at least 1
  /// where torques matter, which are not looked at here.
  [[nodiscard]] double stretch(const Bounds& bounds) const;
};

/// At every moment, not only at samples: accelerations and jerks at their extrema, speeds by a
/// bound from above, as a polynomial lies within the range of its Bernstein coefficients (G. Farin,
/// Curves and Surfaces for CAGD (2002), section 6.1).
/// Jerks only where these matter.
[[nodiscard]] Peaks peaks_of(const Trajectory& trajectory, const Bounds& bounds, bool with_jerk);

}  // namespace mjarm::detail
