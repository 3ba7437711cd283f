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
  JointVec f;  ///< d3q/ds3
};

/// What a cubic spline does at its ends.
enum class SplineEnds {
  not_a_knot,  ///< the first two pieces are one cubic, the last two as well: no made-up curvature
  natural,     ///< no curvature
};

/// Twice continuously differentiable cubic spline through waypoints (C. de Boor, A Practical Guide
/// to Splines (1978), chapter IV). A line through two points; not-a-knot a parabola through three.
class CubicSpline {
 public:
  /// @param s  strictly ascending, at least 2; `q` as many of equal size.
  CubicSpline(std::span<const double> s, std::span<const JointVec> q,
              SplineEnds ends = SplineEnds::not_a_knot);

  [[nodiscard]] double start() const { return s_.front(); }
  [[nodiscard]] double end() const { return s_.back(); }
  [[nodiscard]] int dof() const { return static_cast<int>(q_.front().size()); }
  [[nodiscard]] const std::vector<double>& knots() const { return s_; }
  /// Index of the piece in which `s` lies; the one that begins there for a waypoint.
  [[nodiscard]] std::size_t piece(double s) const;
  /// Point at `s`, clamped to [start(), end()]; exact at the waypoints.
  [[nodiscard]] SplinePoint at(double s) const { return at(s, piece(s)); }
  /// The same by the cubic of one piece, which has its own d3q/ds3 at both of its ends.
  [[nodiscard]] SplinePoint at(double s, std::size_t piece) const;

 private:
  std::vector<double> s_;
  std::vector<JointVec> q_;
  std::vector<JointVec> e_;  // second derivatives at the waypoints
};

}  // namespace mjarm::detail
