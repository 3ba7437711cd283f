#pragma once

#include <span>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/path/curve.hpp"

namespace mjarm {

/// How well executed tool positions follow a curve.
struct PathError {
  double max = 0;       ///< [m] worst distance of an executed position from the curve
  double rms = 0;       ///< [m] root mean square of these distances
  double at = 0;        ///< [m] arc length of the curve where the worst one is
  double coverage = 0;  ///< share of the curve that was passed within `near`, 0 to 1
};

/// Measures positions `p_W` (in order of time) against `curve`. Coverage is counted on points of
/// the curve at most `spacing` apart, each covered when the polyline through the executed positions
/// passes within `near`; a tool that never moved covers next to nothing, however small its error.
/// @param near     [m] > 0
/// @param spacing  [m] > 0
[[nodiscard]] PathError path_error(const Curve& curve, std::span<const Eigen::Vector3d> p_W,
                                   double near = 0.002, double spacing = 0.002);

/// Distance between two tool poses.
struct PoseError {
  double position = 0;  ///< [m]
  double rotation = 0;  ///< [rad]
};
[[nodiscard]] PoseError pose_error(const Pose& X_goal, const Pose& X_WT);

}  // namespace mjarm
