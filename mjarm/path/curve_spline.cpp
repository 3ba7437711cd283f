#include <cmath>
#include <iterator>

#include "mjarm/core/messages/path.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/path/curve_make_internal.hpp"

namespace mjarm {
namespace {

using Vectors = std::vector<Eigen::Vector3d>;

/// Slopes at the knots of the natural cubic spline over pieces of the given `widths` (> 0) and mean
/// slopes `secants` (C. de Boor, A Practical Guide to Splines (1978) ch. 4, eq. 15), by elimination
/// without pivots: the system is diagonally dominant.
Vectors natural_slopes(const std::vector<double>& widths, const Vectors& secants) {
  const std::size_t n = widths.size();
  std::vector<double> upper(n + 1, 0.0);
  Vectors m(n + 1);
  upper[0] = 0.5;
  m[0] = 1.5 * secants[0];
  for (std::size_t i = 1; i <= n; ++i) {
    const bool last = i == n;
    const double h0 = last ? 1 : widths[i - 1], h1 = last ? 1 : widths[i];
    const double lower = h1, diagonal = last ? 2 : 2 * (h0 + h1);
    const Eigen::Vector3d right =
        last ? Eigen::Vector3d(3 * secants[n - 1])
             : Eigen::Vector3d(3 * (h1 * secants[i - 1] + h0 * secants[i]));
    const double pivot = diagonal - lower * upper[i - 1];
    upper[i] = last ? 0 : h0 / pivot;
    m[i] = (right - lower * m[i - 1]) / pivot;
  }
  for (std::size_t i = n; i-- > 0;) m[i] -= upper[i] * m[i + 1];
  return m;
}

/// [rad] between two directions, of any length.
double turn_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Of poses that were checked, of which the first has number `first` among the given ones.
Result<std::vector<CurvePiece>> smooth_pieces(std::span<const Pose> poses, std::size_t first) {
  const std::size_t n = poses.size() - 1;
  std::vector<double> chords(n), lengths(n);
  Vectors secants(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d way = poses[i + 1].p - poses[i].p;
    chords[i] = way.norm();
    secants[i] = way / chords[i];
  }
  const Vectors velocities = natural_slopes(chords, secants);
  std::vector<CurvePiece> pieces(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d &v0 = velocities[i], &v1 = velocities[i + 1];
    CurvePolynomial::Coefficients c = CurvePolynomial::Coefficients::Zero();
    c.col(1) = chords[i] * v0;
    c.col(2) = chords[i] * (3 * secants[i] - 2 * v0 - v1);
    c.col(3) = chords[i] * (v0 + v1 - 2 * secants[i]);
    pieces[i].p0 = poses[i].p;
    pieces[i].bend = CurvePolynomial::create(c);
    if (!pieces[i].bend) {
      return fail(Errc::bad_input, text(msg::path_spline_stops, first + i, first + i + 1));
    }
    pieces[i].length = pieces[i].span = lengths[i] = pieces[i].bend->length();
  }
  Vectors turns(n);
  for (std::size_t i = 0; i < n; ++i) {
    turns[i] = rotation_log(poses[i].R.transpose() * poses[i + 1].R) / lengths[i];
  }
  const Vectors rates = natural_slopes(lengths, turns);
  for (std::size_t i = 0; i < n; ++i) {
    pieces[i].set_turn(poses[i].R, poses[i + 1].R, rates[i], rates[i + 1]);
  }
  return pieces;
}

}  // namespace

Result<Curve> Curve::spline(std::span<const Pose> given, double corner) {
  if (given.size() < 2) {
    return fail(Errc::bad_input, text(msg::path_too_few_points, given.size()));
  }
  const Result<std::vector<Pose>> poses = detail::checked_poses(given);
  if (!poses) return fail(poses.error());
  const std::size_t last = poses->size() - 1;
  const auto chord = [&](std::size_t i) {
    return Eigen::Vector3d((*poses)[i + 1].p - (*poses)[i].p);
  };
  for (std::size_t i = 0; i < last; ++i) {
    if (chord(i).norm() <= detail::kSamePoint) {
      return fail(Errc::bad_input, text(msg::path_spline_same_place, i, i + 1));
    }
  }
  std::vector<CurvePiece> pieces;
  for (std::size_t begin = 0; begin < last;) {
    std::size_t end = begin + 1;
    while (end < last && turn_between(chord(end - 1), chord(end)) <= corner) ++end;
    auto part = smooth_pieces(std::span(*poses).subspan(begin, end - begin + 1), begin);
    if (!part) return fail(std::move(part.error()));
    std::ranges::move(*part, std::back_inserter(pieces));
    begin = end;
  }
  return Curve(std::move(pieces));
}

}  // namespace mjarm
