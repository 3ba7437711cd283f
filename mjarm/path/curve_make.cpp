#include <cmath>
#include <numbers>
#include <optional>

#include "mjarm/core/messages/path.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/path/curve.hpp"

namespace mjarm {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSamePoint = 1e-9;  // [m]
constexpr double kSameTurn = 1e-9;   // [rad]

tl::unexpected<Error> bad(std::string what) { return fail(Errc::bad_input, std::move(what)); }

bool is_rotation(const Eigen::Matrix3d& R) {
  return (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-6 &&
         R.determinant() > 0;
}

/// The poses with their rotations cleaned of rounding, or what is wrong with them.
Result<std::vector<Pose>> checked(std::span<const Pose> poses) {
  std::vector<Pose> clean;
  clean.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose& X = poses[i];
    if (!X.p.allFinite() || !X.R.allFinite()) return bad(text(msg::path_pose_not_finite, i));
    if (!is_rotation(X.R)) return bad(text(msg::path_pose_no_rotation, i));
    clean.push_back({X.p, to_matrix(to_quat(X.R))});
  }
  return clean;
}

/// A straight piece or a turn on the spot; none where the poses are the same.
std::optional<CurvePiece> straight_piece(const Pose& from, const Pose& to) {
  CurvePiece piece;
  const Eigen::Vector3d way = to.p - from.p;
  const Eigen::Vector3d w = rotation_log(from.R.transpose() * to.R);
  piece.p0 = from.p;
  piece.R_ref = from.R;
  piece.turn = w.norm();
  const double length = way.stableNorm();
  if (length > kSamePoint) {
    piece.length = piece.span = length;
    piece.u = way / length;
  } else if (piece.turn > kSameTurn) {
    piece.span = piece.turn;
  } else {
    return std::nullopt;
  }
  piece.w1 = w / piece.span;
  piece.rate = piece.w1.norm();
  return piece;
}

/// Slope at a point between two secants that keeps a cubic Hermite curve from overshooting: their
/// harmonic mean, 0 where they differ in sign (F. N. Fritsch and J. Butland, SIAM J. Sci. Stat.
/// Comput. 5 (1984) 300).
Eigen::Vector3d monotone_slope(const Eigen::Vector3d& before, const Eigen::Vector3d& after) {
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    if (before[i] * after[i] > 0) slope[i] = 2 * before[i] * after[i] / (before[i] + after[i]);
  }
  return slope;
}

/// Sets the rotation of a half arc: at rotation `R_via` with rate `slope` at x_ref, mean rate
/// `secant` over the piece and `secant` again at its other end.
void set_half_turn(CurvePiece& piece, const Eigen::Matrix3d& R_via, double x_ref,
                   const Eigen::Vector3d& slope, const Eigen::Vector3d& secant) {
  const double h = x_ref == 0 ? piece.span : -piece.span;  // from the via point to the other end
  piece.R_ref = R_via;
  piece.x_ref = x_ref;
  piece.w1 = slope;
  piece.w2 = 2 * (secant - slope) / h;
  piece.w3 = (slope - secant) / (h * h);
  piece.turn = secant.norm() * piece.span;
  piece.rate = 2 * secant.norm();  // the slopes are at most twice the secant
}

/// Part of a circle from `from`, its centre at from - radius u, over `angle` [rad] towards v.
CurvePiece round_piece(const Eigen::Vector3d& from, double radius, const Eigen::Vector3d& u,
                       const Eigen::Vector3d& v, double angle) {
  CurvePiece piece;
  piece.round = true;
  piece.p0 = from;
  piece.u = u;
  piece.v = v;
  piece.a = piece.b = radius;
  piece.length = piece.span = radius * angle;
  return piece;
}

}  // namespace

Result<Curve> Curve::line(const Pose& from, const Pose& to) {
  return polyline(std::vector<Pose>{from, to});
}

Result<Curve> Curve::polyline(std::span<const Pose> points) {
  if (points.size() < 2) return bad(text(msg::path_too_few_points, points.size()));
  const Result<std::vector<Pose>> poses = checked(points);
  if (!poses) return fail(poses.error());
  std::vector<CurvePiece> pieces;
  for (std::size_t i = 0; i + 1 < poses->size(); ++i) {
    const std::optional<CurvePiece> piece = straight_piece((*poses)[i], (*poses)[i + 1]);
    if (!piece) return bad(text(msg::path_same_poses, i, i + 1));
    if (!std::isfinite(piece->span)) return bad(text(msg::path_pose_not_finite, i + 1));
    pieces.push_back(*piece);
  }
  return Curve(std::move(pieces));
}

Result<Curve> Curve::arc(const Pose& from, const Pose& via, const Pose& to) {
  constexpr double kOnALine = 1e-6;  // [rad] a flatter triangle has no circle worth the name
  const Result<std::vector<Pose>> poses = checked(std::vector<Pose>{from, via, to});
  if (!poses) return fail(poses.error());
  const Eigen::Matrix3d &R0 = (*poses)[0].R, &R1 = (*poses)[1].R, &R2 = (*poses)[2].R;

  const Eigen::Vector3d d1 = via.p - from.p, d2 = to.p - from.p;
  if (d1.norm() < kSamePoint) return bad(text(msg::path_same_points, 0, 1));
  if (d2.norm() < kSamePoint) return bad(text(msg::path_same_points, 0, 2));
  if ((d2 - d1).norm() < kSamePoint) return bad(text(msg::path_same_points, 1, 2));
  const Eigen::Vector3d n = d1.cross(d2);
  if (n.norm() <= kOnALine * d1.norm() * d2.norm()) return bad(text(msg::path_arc_is_straight));

  // Centre of the circle through three points, seen from the first one.
  const Eigen::Vector3d to_center =
      (d2.squaredNorm() * n.cross(d1) + d1.squaredNorm() * d2.cross(n)) / (2 * n.squaredNorm());
  const double radius = to_center.norm();
  const Eigen::Vector3d w = n.normalized();
  const Eigen::Vector3d u = -to_center / radius, v = w.cross(u);
  const auto angle_of = [&](const Eigen::Vector3d& d) {
    const double angle = std::atan2(v.dot(d), u.dot(d) + radius);
    return angle < 0 ? angle + 2 * kPi : angle;
  };
  const double angle1 = angle_of(d1), angle2 = angle_of(d2);
  if (!std::isfinite(radius) || angle1 >= angle2) return bad(text(msg::path_arc_is_straight));

  CurvePiece first = round_piece(from.p, radius, u, v, angle1);
  const Eigen::Vector3d u1 = std::cos(angle1) * u + std::sin(angle1) * v;
  CurvePiece second = round_piece(via.p, radius, u1, w.cross(u1), angle2 - angle1);
  const Eigen::Vector3d secant1 = -rotation_log(R1.transpose() * R0) / first.span;
  const Eigen::Vector3d secant2 = rotation_log(R1.transpose() * R2) / second.span;
  const Eigen::Vector3d slope = monotone_slope(secant1, secant2);
  set_half_turn(first, R1, first.span, slope, secant1);
  set_half_turn(second, R1, 0, slope, secant2);
  return Curve({first, second});
}

Result<Curve> Curve::ellipse(const Ellipse& ellipse) {
  const auto sound = [](double axis) { return std::isfinite(axis) && axis > 0; };
  if (!sound(ellipse.a)) return bad(text(msg::path_ellipse_axis, "a", ellipse.a));
  if (!sound(ellipse.b)) return bad(text(msg::path_ellipse_axis, "b", ellipse.b));
  if (!ellipse.normal.allFinite() || ellipse.normal.isZero(0)) {
    return bad(text(msg::path_ellipse_normal));
  }
  const Result<std::vector<Pose>> pose = checked(std::vector<Pose>{{ellipse.center, ellipse.R}});
  if (!pose) return bad(text(msg::path_ellipse_pose));

  const EllipseAxes axes = ellipse_axes(ellipse.normal);
  CurvePiece piece;
  piece.round = true;
  piece.p0 = ellipse.center + ellipse.a * axes.u;
  piece.u = axes.u;
  piece.v = axes.v;
  piece.a = ellipse.a;
  piece.b = ellipse.b;
  piece.R_ref = pose->front().R;
  piece.length = piece.span = ellipse_arc_length(ellipse.a, ellipse.b, 2 * kPi);
  if (!std::isfinite(piece.span)) return bad(text(msg::path_ellipse_axis, "a", ellipse.a));
  return Curve({piece});
}

}  // namespace mjarm
