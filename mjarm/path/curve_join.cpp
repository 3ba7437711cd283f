#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mjarm/core/messages/path.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/path/curve_make_internal.hpp"

namespace mjarm {
namespace {

using detail::CurveLeg;
using detail::kSamePoint;

/// Where a bend leaves a leg or comes back to it.
struct BendEnd {
  Eigen::Vector3d t = Eigen::Vector3d::Zero();  ///< unit tangent
  /// [m] the way from the earlier to the later one of this point and the corner, less radius t;
  /// zero on a straight leg.
  Eigen::Vector3d bow = Eigen::Vector3d::Zero();
  Eigen::Vector3d k = Eigen::Vector3d::Zero();  ///< [1/m] curvature, towards the centre
};

/// The quintic from `radius` of way before the corner to `radius` behind it, seen from its first
/// point, that has position, direction and curvature of the legs there (Hermite interpolation).
/// Its velocity is 2 radius at the ends, for which it is between two straight legs the quartic
/// Bezier curve with control points at the corner and at 1 and 1/2 radius on both.
std::optional<CurvePolynomial> bend_between(const BendEnd& from, const BendEnd& to, double radius) {
  const Eigen::Vector3d a0 = 4 * radius * radius * from.k, a1 = 4 * radius * radius * to.k;
  const Eigen::Vector3d change = to.t - from.t, bow = from.bow + to.bow;
  CurvePolynomial::Coefficients c = CurvePolynomial::Coefficients::Zero();
  c.col(1) = 2 * radius * from.t;
  c.col(2) = 0.5 * a0;
  c.col(3) = 2 * radius * change + 10 * bow - 1.5 * a0 + 0.5 * a1;
  c.col(4) = -radius * change - 15 * bow + 1.5 * a0 - a1;
  c.col(5) = 6 * bow - 0.5 * a0 + 0.5 * a1;
  return CurvePolynomial::create(c);
}

bool turns_back(const Eigen::Vector3d& t0, const Eigen::Vector3d& t1) {
  constexpr double kTurnsBack = -0.999847695;  // cos(179 degrees)
  return t0.dot(t1) < kTurnsBack;
}

double length_of(const CurveLeg& leg) {
  double sum = 0;
  for (const CurvePiece& piece : leg) sum += piece.length;
  return sum;
}

/// A place on a leg.
struct LegPoint {
  const CurvePiece& piece;
  double x;  ///< of the piece

  [[nodiscard]] Pose pose() const { return piece.at(x); }
  [[nodiscard]] Eigen::Vector3d rate() const { return piece.turn_rate(x); }
  /// @param way  [m] from the earlier to the later one of this point and the corner.
  [[nodiscard]] BendEnd end(const Eigen::Vector3d& way, double radius) const {
    BendEnd out{.t = piece.direction(x)};
    if (!piece.round) return out;
    out.bow = way - radius * out.t;
    const double theta = x / piece.a;
    out.k = -(std::cos(theta) * piece.u + std::sin(theta) * piece.v) / piece.a;
    return out;
  }
};

LegPoint point_of(const CurveLeg& leg, double x) {
  std::size_t i = 0;
  while (i + 1 < leg.size() && x > leg[i].span) x -= leg[i++].span;
  return {leg[i], std::clamp(x, 0.0, leg[i].span)};
}

/// The piece that replaces the end of one leg and the beginning of the next, `radius` of each; none
/// where the corner stays sharp.
std::optional<CurvePiece> corner_piece(const CurveLeg& before, const CurveLeg& after,
                                       double radius) {
  const CurvePiece &last = before.back(), &first = after.front();
  if (radius <= kSamePoint) return std::nullopt;
  if (turns_back(last.direction(last.span), first.direction(0))) return std::nullopt;
  const LegPoint from = point_of(before, length_of(before) - radius), to = point_of(after, radius);
  const Pose X_from = from.pose(), X_to = to.pose();
  CurvePiece piece;
  piece.p0 = X_from.p;
  piece.bend = bend_between(from.end(first.p0 - X_from.p, radius),
                            to.end(X_to.p - first.p0, radius), radius);
  if (!piece.bend) return std::nullopt;
  piece.length = piece.span = piece.bend->length();
  piece.set_turn(X_from.R, X_to.R, from.rate(), to.rate());
  return piece;
}

/// What is left of a piece without `front` and `back` [m] at its ends.
CurvePiece shortened(CurvePiece piece, double front, double back) {
  if (piece.round) {
    const double theta = front / piece.a;
    piece.p0 = piece.at(front).p;
    const Eigen::Vector3d u = std::cos(theta) * piece.u + std::sin(theta) * piece.v;
    piece.v = std::cos(theta) * piece.v - std::sin(theta) * piece.u;
    piece.u = u;
  } else {
    piece.p0 += front * piece.u;
  }
  piece.x_ref -= front;
  piece.length -= front + back;
  piece.span = piece.length;
  piece.turn = angle_between(piece.at(0).R, piece.at(piece.span).R);
  return piece;
}

/// Adds what is left of a leg without `front` and `back` [m] at its ends.
void add_rest(const CurveLeg& leg, double front, double back, std::vector<CurvePiece>& pieces) {
  double behind = length_of(leg);  // of the leg, behind this piece
  for (const CurvePiece& piece : leg) {
    behind = std::max(0.0, behind - piece.length);
    const double cut_front = std::clamp(front, 0.0, piece.length);
    const double cut_back = std::clamp(back - behind, 0.0, piece.length);
    front -= cut_front;
    if (cut_front == 0 && cut_back == 0) {
      pieces.push_back(piece);
    } else if (piece.length - cut_front - cut_back > kSamePoint) {
      pieces.push_back(shortened(piece, cut_front, cut_back));
    }
  }
}

/// How much of either leg each corner gets: what it wants, at most a quarter of the circle of an
/// arc (beyond it the quintic would bow out too far), and in proportion to what they want where two
/// corners want more of a leg than there is.
std::vector<double> radii_of(std::span<const CurveLeg> legs, std::span<const double> blends) {
  const auto max_of = [](const CurveLeg& leg) {
    if (leg.front().bend || leg.back().bend) return 0.0;  // of a spline
    return leg.front().round ? 0.5 * std::numbers::pi * leg.front().a
                             : std::numeric_limits<double>::infinity();
  };
  std::vector<double> wanted(legs.size() + 1, 0.0), radii(blends.size());  // 0 at the ends
  for (std::size_t i = 0; i < blends.size(); ++i) {
    wanted[i + 1] = std::min({blends[i], max_of(legs[i]), max_of(legs[i + 1])});
  }
  const auto share = [&](std::size_t leg, double own, double other) {
    const double length = length_of(legs[leg]);
    return own + other > length ? length * own / (own + other) : length;
  };
  for (std::size_t i = 0; i < blends.size(); ++i) {
    const double own = wanted[i + 1];
    radii[i] = std::min({own, share(i, own, wanted[i]), share(i + 1, own, wanted[i + 2])});
  }
  return radii;
}

/// Whether a curve is one leg.
bool is_leg(const std::vector<CurvePiece>& pieces) {
  const auto round = [](const CurvePiece& piece) { return piece.round && piece.a == piece.b; };
  const auto bent = [](const CurvePiece& piece) { return piece.bend.has_value(); };
  return std::ranges::all_of(pieces, round) || std::ranges::all_of(pieces, bent) ||
         (pieces.size() == 1 && !pieces[0].round && !pieces[0].bend);
}

}  // namespace

std::optional<Error> detail::blends_error(std::span<const double> blends,
                                          std::size_t inner_points) {
  if (blends.size() != inner_points) {
    return Error{Errc::bad_input, text(msg::path_blend_count, blends.size(), inner_points + 2)};
  }
  for (const double radius : blends) {
    if (!(radius >= 0) || !std::isfinite(radius)) {
      return Error{Errc::bad_input, text(msg::path_blend_radius, radius)};
    }
  }
  return std::nullopt;
}

detail::JoinedLegs detail::join(std::span<const CurveLeg> legs, std::span<const double> blends) {
  const bool sharp = std::ranges::all_of(blends, [](double radius) { return radius == 0; });
  const std::vector<double> radii = radii_of(legs, blends);
  JoinedLegs out;
  double s = 0;      // where the curve ends so far
  double front = 0;  // [m] what the corner before has taken of the leg
  for (std::size_t i = 0; i < legs.size(); ++i) {
    double back = 0;
    std::optional<CurvePiece> corner;
    const bool breaks = i + 1 < legs.size() && !smooth_joint(legs[i].back(), legs[i + 1].front());
    if (breaks) corner = corner_piece(legs[i], legs[i + 1], radii[i]);
    if (corner) back = radii[i];
    const std::size_t count = out.pieces.size();
    add_rest(legs[i], front, back, out.pieces);
    for (std::size_t k = count; k < out.pieces.size(); ++k) s += out.pieces[k].span;
    if (breaks && !sharp) out.blends.push_back({i + 1});
    double nearest = 0;
    if (corner) {
      const Pose given = legs[i + 1].front().at(0);
      nearest = corner->nearest(given.p);
      const Pose X = corner->at(nearest);
      out.blends.back() = {i + 1, radii[i], (X.p - given.p).norm(), angle_between(X.R, given.R)};
    }
    if (i + 1 < legs.size()) out.joints.push_back(s + nearest);
    if (corner) {
      s += corner->span;
      out.pieces.push_back(std::move(*corner));
    }
    front = back;
  }
  return out;
}

Result<Curve> Curve::joined(std::span<const Curve> legs, std::span<const double> blends) {
  if (legs.empty()) return fail(Errc::bad_input, text(msg::path_no_legs));
  if (auto error = detail::blends_error(blends, legs.size() - 1)) return fail(std::move(*error));
  std::vector<detail::CurveLeg> parts;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    if (!is_leg(legs[i].pieces_)) return fail(Errc::bad_input, text(msg::path_no_leg, i));
    if (i > 0) {
      const Pose end = legs[i - 1].at(legs[i - 1].end()), begin = legs[i].at(0);
      const double scale = std::max(1.0, begin.p.cwiseAbs().maxCoeff());
      if ((end.p - begin.p).norm() > kSamePoint * scale ||
          angle_between(end.R, begin.R) > detail::kSameTurn) {
        return fail(Errc::bad_input, text(msg::path_legs_apart, i, i - 1));
      }
    }
    parts.push_back(legs[i].pieces_);
  }
  detail::JoinedLegs joined = detail::join(parts, blends);
  return Curve(std::move(joined.pieces), std::move(joined.blends), std::move(joined.joints));
}

}  // namespace mjarm
