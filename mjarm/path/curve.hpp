#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"

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

/// The `n` poses at theta = linspace(0, 2 pi, n), the last one equal to the first where `endpoint`.
[[nodiscard]] std::vector<Pose> ellipse_points(const Ellipse& ellipse, int n, bool endpoint = false);

/// A curve of tool poses in the world, walked by arc length s in [0, length()] [m]. Rotations turn on
/// the short way, in proportion to the length of their piece. A plain value.
class Curve {
 public:
  /// Straight line with slerp. A pure turn (equal positions) has length 0 and a `turn()`.
  [[nodiscard]] static Result<Curve> line(const Pose& from, const Pose& to);
  /// Straight pieces through all `points` (at least 2), sharp corners.
  [[nodiscard]] static Result<Curve> polyline(std::span<const Pose> points);
  /// Circular arc from `from` through `via` to `to`; fails where the three are on one line.
  [[nodiscard]] static Result<Curve> arc(const Pose& from, const Pose& via, const Pose& to);
  /// One closed lap, from theta = 0.
  [[nodiscard]] static Result<Curve> ellipse(const Ellipse& ellipse);

  [[nodiscard]] double length() const noexcept;  ///< [m]
  [[nodiscard]] double turn() const noexcept;    ///< [rad] total rotation along the curve
  [[nodiscard]] bool closed() const noexcept;
  /// Pose at arc length `s` (clamped to [0, length()]).
  [[nodiscard]] Pose at(double s) const;
  /// Arc lengths where the tangent breaks, ends included, ascending.
  [[nodiscard]] const std::vector<double>& corners() const noexcept;
  /// Arc lengths so that neighbours are at most `step` [m] and `angle` [rad] apart, corners and ends
  /// included.
  [[nodiscard]] std::vector<double> stations(double step, double angle) const;

  /// The point of the curve nearest to `p` [m].
  struct Nearest {
    double s = 0;         ///< [m] arc length of that point
    double distance = 0;  ///< [m]
  };
  [[nodiscard]] Nearest nearest(const Eigen::Vector3d& p) const;

 private:
  struct Piece;
  std::vector<Piece> pieces_;
  std::vector<double> corners_;
};

/// Corner points of the straight strokes of `text` (A-Z, 0-9, space), in the plane's own x (to the
/// right) and y (up) [m], letters `height` high; one polyline a stroke.
[[nodiscard]] Result<std::vector<std::vector<Eigen::Vector2d>>> letter_strokes(
    std::string_view text, double height);

}  // namespace mjarm
