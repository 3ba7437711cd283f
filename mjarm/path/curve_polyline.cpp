#include <algorithm>
#include <cmath>

#include "mjarm/core/messages/path.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/path/curve_make_internal.hpp"

namespace mjarm {
namespace {

/// The piece that replaces the end of one leg and the beginning of the next, `radius` of each.
CurvePiece corner_piece(const CurvePiece& before, const CurvePiece& after, double radius,
                        CurvePolynomial bend) {
  CurvePiece piece;
  piece.p0 = after.p0 - radius * before.u;
  piece.length = piece.span = bend.length();
  piece.bend = std::move(bend);
  piece.set_turn(before.at(before.span - radius).R, after.at(radius).R, before.w1, after.w1);
  return piece;
}

/// What is left of a leg without `front` and `back` [m] at its ends.
CurvePiece shortened(CurvePiece leg, double front, double back) {
  leg.p0 += front * leg.u;
  leg.x_ref = -front;
  leg.length -= front + back;
  leg.span = leg.length;
  leg.turn = leg.rate * leg.length;
  return leg;
}

}  // namespace

std::optional<CurvePolynomial> detail::corner_bend(const Eigen::Vector3d& t0,
                                                   const Eigen::Vector3d& t1, double radius) {
  constexpr double kTurnsBack = -0.999847695;  // cos(179 degrees)
  if (t0.dot(t1) < kTurnsBack) return std::nullopt;
  CurvePolynomial::Coefficients c = CurvePolynomial::Coefficients::Zero();
  c.col(1) = 2 * radius * t0;
  c.col(3) = 2 * radius * (t1 - t0);
  c.col(4) = -radius * (t1 - t0);
  return CurvePolynomial::make(c);
}

std::optional<CurvePiece> detail::straight_piece(const Pose& from, const Pose& to) {
  CurvePiece piece;
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
  return piece;
}

Result<Curve> Curve::polyline(std::span<const Pose> points, double blend) {
  if (!(blend >= 0) || !std::isfinite(blend)) {
    return fail(Errc::bad_input, text(msg::path_blend_radius, blend));
  }
  const std::vector<double> blends(points.size() > 2 ? points.size() - 2 : 0, blend);
  return polyline(points, blends);
}

Result<Curve> Curve::polyline(std::span<const Pose> points, std::span<const double> blend) {
  if (points.size() < 2) {
    return fail(Errc::bad_input, text(msg::path_too_few_points, points.size()));
  }
  if (blend.size() + 2 != points.size()) {
    return fail(Errc::bad_input, text(msg::path_blend_count, blend.size(), points.size()));
  }
  for (const double radius : blend) {
    if (!(radius >= 0) || !std::isfinite(radius)) {
      return fail(Errc::bad_input, text(msg::path_blend_radius, radius));
    }
  }
  const Result<std::vector<Pose>> poses = detail::checked_poses(points);
  if (!poses) return fail(poses.error());
  std::vector<CurvePiece> legs;
  for (std::size_t i = 0; i + 1 < poses->size(); ++i) {
    const std::optional<CurvePiece> leg = detail::straight_piece((*poses)[i], (*poses)[i + 1]);
    if (!leg) return fail(Errc::bad_input, text(msg::path_same_poses, i, i + 1));
    legs.push_back(*leg);
  }
  if (std::ranges::all_of(blend, [](double radius) { return radius == 0; })) {
    return Curve(std::move(legs));
  }
  // What of a leg the corner may take that wants `own` of it and whose neighbour wants `other`.
  const auto share = [&](std::size_t leg, double own, double other) {
    const double length = legs[leg].length;
    return own + other > length ? length * own / (own + other) : length;
  };
  const auto wanted = [&](std::size_t point) {  // by the corner at a point; none at the ends
    return point == 0 || point > blend.size() ? 0 : blend[point - 1];
  };
  std::vector<CurvePiece> pieces;
  std::vector<CurveBlend> blends;
  double front = 0;  // [m] what the corner before has taken of the leg
  for (std::size_t i = 0; i < legs.size(); ++i) {
    double back = 0;
    std::optional<CurvePiece> corner;
    if (i + 1 < legs.size() && !detail::smooth_joint(legs[i], legs[i + 1])) {
      const double own = wanted(i + 1);
      const double radius =
          std::min({own, share(i, own, wanted(i)), share(i + 1, own, wanted(i + 2))});
      std::optional<CurvePolynomial> bend;
      if (radius > detail::kSamePoint) bend = detail::corner_bend(legs[i].u, legs[i + 1].u, radius);
      if (bend) {
        back = radius;
        corner = corner_piece(legs[i], legs[i + 1], radius, std::move(*bend));
        const Pose middle = corner->at(0.5 * corner->span);
        blends.push_back({i + 1, radius, (middle.p - legs[i + 1].p0).norm(),
                          angle_between(middle.R, legs[i + 1].R_ref)});
      } else {
        blends.push_back({i + 1});
      }
    }
    if (legs[i].length == 0) {
      pieces.push_back(legs[i]);
    } else if (legs[i].length - front - back > detail::kSamePoint) {
      pieces.push_back(shortened(legs[i], front, back));
    }
    if (corner) pieces.push_back(std::move(*corner));
    front = back;
  }
  return Curve(std::move(pieces), std::move(blends));
}

}  // namespace mjarm
