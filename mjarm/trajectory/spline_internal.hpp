#pragma once

#include <span>
#include <vector>

#include "mjarm/core/joint_vec.hpp"

namespace mjarm::detail {

/// Joint values as a function of the path parameter, and their derivatives by it.
struct SplinePoint {
  JointVec q;  ///< [rad or m]
  JointVec d;  ///< dq/ds
  JointVec e;  ///< d2q/ds2
};

/// Twice continuously differentiable cubic spline through waypoints. Not-a-knot ends: the first two
/// pieces are one cubic, the last two as well, so that no curvature is made up at the ends (C. de
/// Boor, A Practical Guide to Splines (1978), chapter IV). A line through two points, a parabola
/// through three.
class CubicSpline {
 public:
  /// @param s  strictly ascending, at least 2; `q` as many of equal size.
  CubicSpline(std::span<const double> s, std::span<const JointVec> q);

  [[nodiscard]] double start() const { return s_.front(); }
  [[nodiscard]] double end() const { return s_.back(); }
  [[nodiscard]] const std::vector<double>& knots() const { return s_; }
  /// Point at `s`, clamped to [start(), end()]; exact at the waypoints.
  [[nodiscard]] SplinePoint at(double s) const;

 private:
  std::vector<double> s_;
  std::vector<JointVec> q_;
  std::vector<JointVec> e_;  // second derivatives at the waypoints
};

}  // namespace mjarm::detail
