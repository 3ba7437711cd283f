#pragma once

#include <span>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm {

/// How hard to try. Every default is usable as is.
struct ViaOptions {
  int iterations = 100;      ///< most steps of the optimiser, >= 0; it mostly stops after 10 to 20
  double joint_share = 1.0;  ///< share of the joints' velocity and acceleration limits, (0, 1]
  StopCheck stop = {};       ///< asked every 512 waypoints; ends the work
};

/// A motion through waypoints.
struct ViaMotion {
  Trajectory trajectory;
  std::vector<double> times;  ///< [s] when each waypoint is met, ascending from 0; equal for equals
};

/// The fastest motion through joint waypoints in their order, at rest at both ends, within
/// velocity, acceleration and jerk limits; its shape between the waypoints is free. All joints pass
/// a waypoint at one time, without stopping. The jerk is constant in each of 16 equal cells between
/// waypoints, and the durations and the jerks are optimised together, so that the result is a local
/// optimum of such motions; it is never slower than stopping at every waypoint. Takes time in
/// proportion to the number of waypoints. Mind that joint positions are not bounded between
/// waypoints. Same input, same bytes.
/// @param waypoints  [rad or m] at least one, finite, of equal size; equal neighbours are one.
/// @return an error for bad sizes or numbers, limits that are not positive, bad options; system
///         where `stop` ended the work.
[[nodiscard]] Result<ViaMotion> time_via_points(std::span<const JointVec> waypoints,
                                                const JointLimits& limits,
                                                const ViaOptions& options = {});

}  // namespace mjarm
