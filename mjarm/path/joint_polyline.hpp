#pragma once

#include <span>
#include <vector>

#include "mjarm/path/joint_path.hpp"

namespace mjarm {

/// How a joint polyline is rounded and sampled. Lengths are those of joint space: the L2 norm over
/// all joints, [rad or m].
struct JointPolylineOptions {
  double blend = 0;  ///< the straight legs are left within this of a waypoint, >= 0; 0: sharp
  /// The same for every inner waypoint, each its own; empty: `blend` for all.
  std::vector<double> blends = {};
  double step = 0.05;  ///< largest distance of neighbouring samples, > 0
};

/// A way through joint waypoints, straight in joint space, parametrised by its length there.
struct JointPolyline {
  JointPath path;               ///< samples; waypoints with sharp corners among them
  std::vector<double> corners;  ///< parameters where the direction breaks, ends included, ascending
  std::vector<double> radii;    ///< blend used at every inner waypoint; 0: passed sharp or straight
};

/// Straight legs through all `waypoints` (at least 2, shape (dof,) each, neighbours apart), corners
/// rounded with continuous curvature as those of Curve::polyline: two corners share the leg between
/// them by halves, corners that turn back stay sharp.
/// @return an error for sizes that differ, numbers that are not finite, neighbours that are the
///   same, or more than 10 million samples.
[[nodiscard]] Result<JointPolyline> joint_polyline(std::span<const JointVec> waypoints,
                                                   const JointPolylineOptions& options = {});

}  // namespace mjarm
