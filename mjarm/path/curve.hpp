#pragma once

#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/path/curve_piece.hpp"
#include "mjarm/path/ellipse.hpp"

namespace mjarm {

/// What became of a corner of a polyline or of joined legs.
struct CurveBlend {
  std::size_t point = 0;  ///< index of the given pose; of joined legs: of the leg behind the corner
  double radius = 0;      ///< [m] of way the legs are left within it; 0: the corner stays sharp
  double distance = 0;    ///< [m] how near the curve comes to the given point
  double turn = 0;        ///< [rad] between the given rotation and that at the nearest point
};

/// A curve of tool poses in the world, walked by its arc length s in [0, end()] [m]; where the tool
/// turns on the spot, s counts the angle [rad] instead. Rotations take the short way. A plain
/// value. Every maker fails on numbers that are not finite or over 1e6 m, on matrices that are no
/// rotations (to 1e-6) and on neighbours that are the same pose.
class Curve {
 public:
  /// Straight line with slerp. Equal positions make a turn on the spot, of length 0.
  [[nodiscard]] static Result<Curve> line(const Pose& from, const Pose& to);
  /// Straight pieces through all `points` (at least 2), each with its slerp. Corners are sharp
  /// where `blend` is 0, else rounded: the tool leaves its straight legs only within `blend` [m] of
  /// the corner, with continuous curvature and rate of turn, so it is never farther than that from
  /// them. Two corners for whom the leg between them is too short share it in proportion to what
  /// they want; blends() says how much that is. Corners that turn back (by over 179 degrees) and
  /// turns on the spot stay sharp.
  [[nodiscard]] static Result<Curve> polyline(std::span<const Pose> points, double blend = 0);
  /// The same with a blend of its own for each inner point.
  [[nodiscard]] static Result<Curve> polyline(std::span<const Pose> points,
                                              std::span<const double> blends);
  /// Legs one after another, each from line(), arc() (or circle(), where it is whole) or spline(),
  /// whose corners stay sharp. Corners
  /// between them are rounded as those of a polyline: the tool leaves its legs only within
  /// `blends`[i] [m] of way from the corner between legs i and i + 1 and stays that near to it;
  /// direction, curvature and rate of turn are continuous. Of an arc a corner takes a quarter of
  /// the circle at most. Legs that go on in the same direction and at the same rate of turn have
  /// no corner and stay as they are, though the curvature jumps from a line to an arc; a bend that
  /// would come to a stop on its way leaves the corner sharp. Fails where there is no leg, where
  /// one does not begin at the pose where the one before ends, and on other curves.
  [[nodiscard]] static Result<Curve> joined(std::span<const Curve> legs,
                                            std::span<const double> blends);
  /// Circular arc from `from` through `via` to `to`; fails where the three are on one line. The
  /// rotation goes through that of `via` too, at a rate without jumps (and constant where it can
  /// be).
  [[nodiscard]] static Result<Curve> arc(const Pose& from, const Pose& via, const Pose& to);
  /// The whole circle: from `from` through `via` and `to` back to `from`, rotations likewise.
  [[nodiscard]] static Result<Curve> circle(const Pose& from, const Pose& via, const Pose& to);
  /// The whole circle round `center` with one fixed tool orientation; where it begins and which way
  /// it goes as for an ellipse.
  [[nodiscard]] static Result<Curve> circle(const Eigen::Vector3d& center,
                                            const Eigen::Vector3d& normal, double radius,
                                            const Eigen::Matrix3d& R);
  /// One closed lap, from theta = 0.
  [[nodiscard]] static Result<Curve> ellipse(const Ellipse& ellipse);
  /// Smooth curve through all `poses` (at least 2, neighbours at different places): the natural
  /// cubic spline over the chord lengths, so direction and curvature are continuous (C. de Boor, A
  /// Practical Guide to Splines (1978) ch. 4); between two rotations a cubic in the rotation
  /// vector, whose rates are those of the spline through the mean rates, so the rate of turn is
  /// continuous. Fails where the curve would stop and turn back.
  /// @param corner  [rad] where the chords turn by more, the curve has a corner: a spline ends and
  ///                another begins; pi: nowhere.
  [[nodiscard]] static Result<Curve> spline(std::span<const Pose> poses,
                                            double corner = std::numbers::pi);

  [[nodiscard]] double length() const noexcept;  ///< [m]
  [[nodiscard]] double turn() const noexcept;    ///< [rad] sum of the turns between the given poses
  /// Largest parameter: the length, and the angle of every turn on the spot.
  [[nodiscard]] double end() const noexcept;
  /// True where the last pose is the first one (to 1e-9).
  [[nodiscard]] bool closed() const noexcept;
  /// Pose at parameter `s`, clamped to [0, end()].
  [[nodiscard]] Pose at(double s) const;
  /// Pose at each of `s`.
  [[nodiscard]] std::vector<Pose> poses(std::span<const double> s) const;
  /// Parameters where the direction or the rate of turn breaks, ends included, ascending.
  [[nodiscard]] const std::vector<double>& corners() const noexcept;
  /// What became of the corners of a polyline or of joined legs with blends, ascending; empty for
  /// all other curves.
  [[nodiscard]] const std::vector<CurveBlend>& blends() const noexcept;
  /// Parameters at which the legs of a polyline or of joined legs meet, ascending, one for each
  /// inner point; where a corner is rounded, of the point nearest to it. Empty for all other
  /// curves.
  [[nodiscard]] const std::vector<double>& breaks() const noexcept;
  /// Parameters so that neighbours are at most `step` [m] and `angle` [rad] apart (both > 0),
  /// evenly spread between the ends of the pieces; corners and ends included exactly.
  [[nodiscard]] std::vector<double> stations(double step, double angle) const;

  /// The point of the curve nearest to `p` [m].
  struct Nearest {
    double s = 0;         ///< parameter of that point; the smallest where several are as near
    double distance = 0;  ///< [m]
  };
  /// Direct for straight and round pieces, branch and bound for the others: always global.
  [[nodiscard]] Nearest nearest(const Eigen::Vector3d& p) const;

 private:
  explicit Curve(std::vector<CurvePiece> pieces, std::vector<CurveBlend> blends = {},
                 std::vector<double> joints = {});

  std::vector<CurvePiece> pieces_;  // at least one
  std::vector<double> corners_;
  std::vector<CurveBlend> blends_;
  std::vector<double> breaks_;
};

}  // namespace mjarm
