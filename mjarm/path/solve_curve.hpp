#pragma once

#include <numbers>
#include <span>

#include "mjarm/core/result.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/path/path_change.hpp"
#include "mjarm/path/solve_path.hpp"

namespace mjarm {

/// How finely a curve is followed. Every default is usable as is.
struct CurveOptions {
  PathOptions path = {};
  /// Between waypoints the joints move straight; so far the tool may leave the curve there.
  /// Stretches in which no joint moves by 1e-5 rad or m are not halved, whatever the tolerance.
  double pos_tol = 1e-4;                     ///< [m]   > 0
  double rot_tol = std::numbers::pi / 1800;  ///< [rad] > 0
  /// Waypoints are at most so far apart, whatever the tolerance; limits, singularities and
  /// clearance are looked at there.
  double step = 0.01;      ///< [m]   > 0
  double turn = 0.1;       ///< [rad] > 0
  PathChange change = {};  ///< of every pose of the curve
};

/// Joint values along a curve, by solve_path(), in as many waypoints as the tolerance asks for: the
/// stretches between them are halved until it is kept, and where no branch seems to go on, until
/// the place is known to 1e-5 m or rad (1e-8 where the joints race). At most 200,000 waypoints to
/// begin with: a longer curve gets longer steps.
/// @return failure with `s`, where the curve stops, and `fraction` of its parameter; `at` counts
///         the waypoints before it.
[[nodiscard]] Result<JointPath, PathFailure> solve_curve(const IkSolver& ik, const Curve& curve,
                                                         std::span<const double> q_start,
                                                         const CurveOptions& options = {});

}  // namespace mjarm
