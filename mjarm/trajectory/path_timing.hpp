#pragma once

#include <span>

#include "mjarm/trajectory/inverse_dynamics.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm {

/// What holds while a given path is walked.
struct PathTimingOptions {
  bool jerk_limits = true;        ///< false: accelerations may jump, which is a little faster
  InverseDynamics dynamics = {};  ///< given: torques keep their limits as well, to 1 in 1000
  double torque_share = 1.0;      ///< share of `limits.torque`, (0, 1]; not used without `dynamics`
};

/// The fastest motion along one given path, from rest to rest: the natural cubic spline over chord
/// length through `waypoints`. Waypoints that repeat the one before count once; where nothing is
/// left of the path the motion is a rest of no duration. Limits hold at every moment. Without jerk
/// limits within about 0.1 % of the shortest time there is.
/// @param waypoints  [rad or m] at least 1 of equal size, all finite.
/// @return an error for sizes, numbers or limits that make no sense, naming the waypoint; and for a
///         path on which the arm cannot be held still against gravity, naming joint and place.
[[nodiscard]] Result<Trajectory> time_waypoint_path(std::span<const JointVec> waypoints,
                                                    const JointLimits& limits,
                                                    const PathTimingOptions& options = {});

}  // namespace mjarm
