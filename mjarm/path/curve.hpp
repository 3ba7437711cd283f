#pragma once

#include <span>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/path/curve_piece.hpp"
#include "mjarm/path/ellipse.hpp"

namespace mjarm {

/// A curve of tool poses in the world, walked by its arc length s in [0, end()] [m]; where the tool
/// turns on the spot, s counts the angle [rad] instead. Rotations take the short way. A plain
/// value. Every maker fails on numbers that are not finite, on matrices that are no rotations (to
/// 1e-6) and on neighbours that are the same pose.
class Curve {
 public:
  /// Straight line with slerp. Equal positions make a turn on the spot, of length 0.
  [[nodiscard]] static Result<Curve> line(const Pose& from, const Pose& to);
  /// Straight pieces through all `points` (at least 2), sharp corners, each with its slerp.
  [[nodiscard]] static Result<Curve> polyline(std::span<const Pose> points);
  /// Circular arc from `from` through `via` to `to`; fails where the three are on one line. The
  /// rotation goes through that of `via` too, at a rate without jumps (and constant where it can
  /// be).
  [[nodiscard]] static Result<Curve> arc(const Pose& from, const Pose& via, const Pose& to);
  /// One closed lap, from theta = 0.
  [[nodiscard]] static Result<Curve> ellipse(const Ellipse& ellipse);

  [[nodiscard]] double length() const noexcept;  ///< [m]
  [[nodiscard]] double turn() const noexcept;    ///< [rad] sum of the turns between the given poses
  /// Largest parameter: the length, and the angle of every turn on the spot.
  [[nodiscard]] double end() const noexcept;
  /// True where the last pose is the first one (to 1e-9).
  [[nodiscard]] bool closed() const noexcept;
  /// Pose at parameter `s`, clamped to [0, end()].
  [[nodiscard]] Pose at(double s) const;
  /// Parameters where the direction or the rate of turn breaks, ends included, ascending.
  [[nodiscard]] const std::vector<double>& corners() const noexcept;
  /// Parameters so that neighbours are at most `step` [m] and `angle` [rad] apart (both > 0),
  /// evenly spread between the ends of the pieces; corners and ends included exactly.
  [[nodiscard]] std::vector<double> stations(double step, double angle) const;

  /// The point of the curve nearest to `p` [m].
  struct Nearest {
    double s = 0;         ///< parameter of that point; the smallest where several are as near
    double distance = 0;  ///< [m]
  };
  /// Closed form for every piece, so the answer is global.
  [[nodiscard]] Nearest nearest(const Eigen::Vector3d& p) const;

 private:
  explicit Curve(std::vector<CurvePiece> pieces);

  std::vector<CurvePiece> pieces_;  // at least one
  std::vector<double> corners_;
};

}  // namespace mjarm
