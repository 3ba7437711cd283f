#include "mjarm/core/messages/path.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/path/curve_make_internal.hpp"

namespace mjarm {

std::optional<CurvePiece> detail::straight_piece(const Pose& from, const Pose& to) {
  std::optional<CurvePiece> made(std::in_place);
  CurvePiece& piece = *made;
  const Eigen::Vector3d way = to.p - from.p;
  const Eigen::Vector3d w = rotation_log(from.R.transpose() * to.R);
  piece.p0 = from.p;
  piece.R_ref = from.R;
  piece.turn = w.norm();
  const double length = way.norm();
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
  return made;
}

Result<Curve> Curve::polyline(std::span<const Pose> points, double blend) {
  const double one[] = {blend};  // checked where there is no inner point, too
  if (auto error = detail::blends_error(one, 1)) return fail(std::move(*error));
  const std::vector<double> blends(points.size() > 2 ? points.size() - 2 : 0, blend);
  return polyline(points, blends);
}

Result<Curve> Curve::polyline(std::span<const Pose> points, std::span<const double> blends) {
  if (points.size() < 2) {
    return fail(Errc::bad_input, text(msg::path_too_few_points, points.size()));
  }
  if (auto error = detail::blends_error(blends, points.size() - 2)) return fail(std::move(*error));
  const Result<std::vector<Pose>> poses = detail::checked_poses(points);
  if (!poses) return fail(poses.error());
  std::vector<detail::CurveLeg> legs;
  for (std::size_t i = 0; i + 1 < poses->size(); ++i) {
    const std::optional<CurvePiece> leg = detail::straight_piece((*poses)[i], (*poses)[i + 1]);
    if (!leg) return fail(Errc::bad_input, text(msg::path_same_poses, i, i + 1));
    legs.push_back({*leg});
  }
  detail::JoinedLegs joined = detail::join(legs, blends);
  return Curve(std::move(joined.pieces), std::move(joined.blends), std::move(joined.joints));
}

}  // namespace mjarm
