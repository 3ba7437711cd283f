#pragma once

#include <Eigen/Core>

#include "mjarm/core/pose.hpp"

namespace mjarm {

/// One smooth piece of a tool curve: a straight line, a turn on the spot, or a part of an ellipse
/// (of a circle where a = b). Its local parameter x runs over [0, span].
struct CurvePiece {
  double start = 0;   ///< parameter of the whole curve where this piece begins
  double span = 0;    ///< [m] its length; [rad] the angle of a turn on the spot; > 0
  double length = 0;  ///< [m] 0 for a turn on the spot
  double turn = 0;    ///< [rad] angle between the rotations at its ends
  double rate = 0;    ///< [rad per unit of x] the tool never turns faster along the piece

  bool round = false;  ///< false: p = p0 + x u; true: p0 + a (cos(t) - 1) u + b sin(t) v
  Eigen::Vector3d p0 = Eigen::Vector3d::Zero();  ///< [m] first point
  Eigen::Vector3d u = Eigen::Vector3d::Zero();   ///< unit; zero for a turn on the spot
  Eigen::Vector3d v = Eigen::Vector3d::Zero();   ///< unit, perpendicular to u; for round ones
  double a = 0;                                  ///< [m] semi-axis along u
  double b = 0;                                  ///< [m] semi-axis along v

  /// R(x) = R_ref exp(w1 d + w2 d^2 + w3 d^3) with d = x - x_ref.
  Eigen::Matrix3d R_ref = Eigen::Matrix3d::Identity();
  double x_ref = 0;
  Eigen::Vector3d w1 = Eigen::Vector3d::Zero();
  Eigen::Vector3d w2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d w3 = Eigen::Vector3d::Zero();

  /// Pose at `x` in [0, span].
  [[nodiscard]] Pose at(double x) const;
  /// The x in [0, span] whose point is nearest to `p` [m].
  [[nodiscard]] double nearest(const Eigen::Vector3d& p) const;
};

}  // namespace mjarm
