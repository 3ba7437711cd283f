#include <cmath>
#include <numbers>
#include <vector>

#include "mjarm/core/messages/path.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/path/curve_make_internal.hpp"

namespace mjarm {
namespace {

using std::numbers::pi;

tl::unexpected<Error> bad(std::string what) { return fail(Errc::bad_input, std::move(what)); }

bool is_rotation(const Eigen::Matrix3d& R) {
  return (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-6 &&
         R.determinant() > 0;
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

/// The circle through three poses in pieces between them: two, or three where it is `whole`; still
/// without rotations.
Result<std::vector<CurvePiece>> circle_pieces(std::span<const Pose> poses, bool whole) {
  constexpr double kOnALine = 1e-6;  // [rad] a flatter triangle has no circle worth the name
  const Eigen::Vector3d d1 = poses[1].p - poses[0].p, d2 = poses[2].p - poses[0].p;
  if (d1.norm() < detail::kSamePoint) return bad(text(msg::path_same_points, 0, 1));
  if (d2.norm() < detail::kSamePoint) return bad(text(msg::path_same_points, 0, 2));
  if ((d2 - d1).norm() < detail::kSamePoint) return bad(text(msg::path_same_points, 1, 2));
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
    return angle < 0 ? angle + 2 * pi : angle;
  };
  const double angles[] = {0, angle_of(d1), angle_of(d2), 2 * pi};
  if (!std::isfinite(radius) || angles[1] >= angles[2]) return bad(text(msg::path_arc_is_straight));

  std::vector<CurvePiece> pieces;
  for (std::size_t i = 0; i < (whole ? 3 : 2); ++i) {
    const Eigen::Vector3d ui = std::cos(angles[i]) * u + std::sin(angles[i]) * v;
    pieces.push_back(round_piece(poses[i].p, radius, ui, w.cross(ui), angles[i + 1] - angles[i]));
  }
  return pieces;
}

/// Gives the pieces of a circle rotations through those of the poses; the rate of turn is
/// continuous between pieces, and at the seam too where the last piece ends in the first pose.
void set_turns(std::vector<CurvePiece>& pieces, std::span<const Pose> poses) {
  const std::size_t n = pieces.size();
  const auto R = [&](std::size_t i) -> const Eigen::Matrix3d& { return poses[i % 3].R; };
  std::vector<Eigen::Vector3d> secants, slopes;
  for (std::size_t i = 0; i < n; ++i) {
    secants.push_back(rotation_log(R(i).transpose() * R(i + 1)) / pieces[i].span);
  }
  const bool whole = n == 3;
  slopes.push_back(whole ? monotone_slope(secants.back(), secants.front()) : secants.front());
  for (std::size_t i = 1; i < n; ++i) slopes.push_back(monotone_slope(secants[i - 1], secants[i]));
  slopes.push_back(whole ? slopes.front() : secants.back());
  for (std::size_t i = 0; i < n; ++i) pieces[i].set_turn(R(i), R(i + 1), slopes[i], slopes[i + 1]);
}

Result<std::vector<CurvePiece>> pieces_through(std::span<const Pose> given, bool whole) {
  const Result<std::vector<Pose>> poses = detail::checked_poses(given);
  if (!poses) return fail(poses.error());
  Result<std::vector<CurvePiece>> pieces = circle_pieces(*poses, whole);
  if (pieces) set_turns(*pieces, *poses);
  return pieces;
}

}  // namespace

Result<std::vector<Pose>> detail::checked_poses(std::span<const Pose> poses) {
  std::vector<Pose> clean;
  clean.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose& X = poses[i];
    if (!X.p.allFinite() || !X.R.allFinite()) return bad(text(msg::path_pose_not_finite, i));
    if (X.p.cwiseAbs().maxCoeff() > kFarthest) return bad(text(msg::path_pose_too_far, i));
    if (!is_rotation(X.R)) return bad(text(msg::path_pose_no_rotation, i));
    clean.push_back({X.p, to_matrix(to_quat(X.R))});
  }
  return clean;
}

Result<Curve> Curve::line(const Pose& from, const Pose& to) {
  return polyline(std::vector<Pose>{from, to});
}

Result<Curve> Curve::arc(const Pose& from, const Pose& via, const Pose& to) {
  Result<std::vector<CurvePiece>> pieces = pieces_through(std::vector<Pose>{from, via, to}, false);
  if (!pieces) return fail(std::move(pieces.error()));
  return Curve(std::move(*pieces));
}

Result<Curve> Curve::circle(const Pose& from, const Pose& via, const Pose& to) {
  Result<std::vector<CurvePiece>> pieces = pieces_through(std::vector<Pose>{from, via, to}, true);
  if (!pieces) return fail(std::move(pieces.error()));
  return Curve(std::move(*pieces));
}

Result<Curve> Curve::circle(const Eigen::Vector3d& center, const Eigen::Vector3d& normal,
                            double radius, const Eigen::Matrix3d& R) {
  if (!(radius >= detail::kSamePoint && radius <= detail::kFarthest)) {
    return bad(text(msg::path_circle_radius, radius));
  }
  return ellipse({center, radius, radius, normal, R});
}

Result<Curve> Curve::ellipse(const Ellipse& ellipse) {
  const auto sound = [](double axis) {
    return axis >= detail::kSamePoint && axis <= detail::kFarthest;
  };
  if (!sound(ellipse.a)) return bad(text(msg::path_ellipse_axis, "a", ellipse.a));
  if (!sound(ellipse.b)) return bad(text(msg::path_ellipse_axis, "b", ellipse.b));
  if (!ellipse.normal.allFinite() || ellipse.normal.isZero(0)) {
    return bad(text(msg::path_ellipse_normal));
  }
  const Result<std::vector<Pose>> pose =
      detail::checked_poses(std::vector<Pose>{{ellipse.center, ellipse.R}});
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
  piece.length = piece.span = ellipse_arc_length(ellipse.a, ellipse.b, 2 * pi);
  return Curve({piece});
}

}  // namespace mjarm
