#pragma once

#include <vector>

#include "mjarm/core/pose.hpp"

namespace mjarm {

/// An ellipse in space with one fixed tool orientation.
/// P(theta) = center + a cos(theta) u + b sin(theta) v, with w = normal/|normal|, u = the world's x
/// axis made perpendicular to w (its y axis where |w.x| > 0.9), v = w x u. A circle has a = b.
struct Ellipse {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();   ///< [m]
  double a = 0.1;                                     ///< [m] semi-axis along u, > 0
  double b = 0.1;                                     ///< [m] semi-axis along v, > 0
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< any length but zero
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();    ///< tool orientation all the way
};

/// The unit axes of an ellipse's plane, right-handed.
struct EllipseAxes {
  Eigen::Vector3d u;
  Eigen::Vector3d v;
  Eigen::Vector3d w;
};
/// Axes for a `normal` of any length but zero.
[[nodiscard]] EllipseAxes ellipse_axes(const Eigen::Vector3d& normal);

/// The `n` poses at theta = linspace(0, 2 pi, n); the last one equals the first where `endpoint`,
/// else it stands one step before. Empty for n <= 0.
[[nodiscard]] std::vector<Pose> ellipse_points(const Ellipse& ellipse, int n, bool endpoint = true);

/// Length [m] of the ellipse (a cos(t), b sin(t)) from t = 0 to `theta`, any sign; odd and
/// increasing in theta. Exact to rounding for every a, b > 0 (Carlson's symmetric integrals, B. C.
/// Carlson, Numerical Algorithms 10 (1995) 13).
[[nodiscard]] double ellipse_arc_length(double a, double b, double theta);

/// Inverse of ellipse_arc_length.
[[nodiscard]] double ellipse_angle(double a, double b, double length);

}  // namespace mjarm
