#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "mjarm/core/pose.hpp"
#include "mjarm/path/curve_polynomial.hpp"

namespace mjarm {

/// One smooth piece of a tool curve: a straight line, a turn on the spot, a part of an ellipse (of
/// a circle where a = b) or of a polynomial. Its local parameter x runs over [0, span].
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
  std::optional<CurvePolynomial> bend;           ///< if set: p = p0 + bend(x)

  /// R(x) = R_ref exp(w(d)), w = w1 d + w2 d^2 + w3 d^3, d = x - x_ref.
  Eigen::Matrix3d R_ref = Eigen::Matrix3d::Identity();
  double x_ref = 0;
  Eigen::Vector3d w1 = Eigen::Vector3d::Zero();
  Eigen::Vector3d w2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d w3 = Eigen::Vector3d::Zero();

  /// Sets the rotation from `R0` to `R1` (`span` must be set): w is the cubic with the rates
  /// `rate0` and `rate1` of the tool at the ends, axes of the tool, [rad per unit of x]; the far
  /// one is brought to w' by the inverse of the right Jacobian of the exponential map (G. S.
  /// Chirikjian, Stochastic Models, Information Theory, and Lie Groups 2 (2012) 40).
  void set_turn(const Eigen::Matrix3d& R0, const Eigen::Matrix3d& R1, const Eigen::Vector3d& rate0,
                const Eigen::Vector3d& rate1);

  /// Pose at `x` in [0, span].
  [[nodiscard]] Pose at(double x) const;
  /// Unit tangent at `x`; zero for a turn on the spot.
  [[nodiscard]] Eigen::Vector3d direction(double x) const;
  /// Angular velocity per unit of x, axes of the tool.
  [[nodiscard]] Eigen::Vector3d turn_rate(double x) const;
  /// The x in [0, span] whose point is nearest to `p` [m]; any x where none is nearer than
  /// `within`.
  [[nodiscard]] double nearest(const Eigen::Vector3d& p,
                               double within = std::numeric_limits<double>::infinity()) const;
};

}  // namespace mjarm
