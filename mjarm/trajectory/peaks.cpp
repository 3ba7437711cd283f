#include <algorithm>
#include <cmath>

#include "mjarm/trajectory/peaks_internal.hpp"

namespace mjarm::detail {
namespace {

/// Largest Bernstein coefficient, as a magnitude, of the sum of p[k] x^k over x in [0, 1].
double peak_of_quartic(const double (&p)[5]) {
  const double b[5] = {p[0], p[0] + p[1] / 4, p[0] + p[1] / 2 + p[2] * (1. / 6),
                       p[0] + 0.75 * p[1] + p[2] / 2 + p[3] / 4, p[0] + p[1] + p[2] + p[3] + p[4]};
  double max = 0;
  for (const double x : b) max = std::max(max, std::abs(x));
  return max;
}

/// Largest magnitude of the sum of p[k] x^k over x in [0, 1].
double peak_of_quadratic(const double (&p)[3]) {
  double max = std::max(std::abs(p[0]), std::abs(p[0] + p[1] + p[2]));
  const double turn = -0.5 * p[1] / p[2];
  if (turn > 0 && turn < 1) max = std::max(max, std::abs(p[0] + 0.5 * turn * p[1]));
  return max;
}

/// At least as much, for a cubic; spares most of them the exact extremum.
double bound_of_cubic(const double (&p)[4]) {
  constexpr double kThird = 1. / 3;
  return std::max({std::abs(p[0]), std::abs(p[0] + kThird * p[1]),
                   std::abs(p[0] + kThird * (2 * p[1] + p[2])),
                   std::abs(p[0] + p[1] + p[2] + p[3])});
}

double peak_of_cubic(const double (&p)[4]) {
  double max = std::max(std::abs(p[0]), std::abs(p[0] + p[1] + p[2] + p[3]));
  // Where p1 + 2 p2 x + 3 p3 x^2 = 0, in the form that loses no digits.
  const double inside = p[2] * p[2] - 3 * p[1] * p[3];
  if (inside < 0) return max;
  const double r = -(p[2] + std::copysign(std::sqrt(inside), p[2]));
  for (const double x : {r / (3 * p[3]), p[1] / r}) {
    if (x > 0 && x < 1) max = std::max(max, std::abs(p[0] + x * (p[1] + x * (p[2] + x * p[3]))));
  }
  return max;
}

}  // namespace

double Peaks::stretch(const Bounds& bounds) const {
  return std::max({v, std::sqrt(a), std::cbrt(j), bounds.dynamics ? 1. : 0.});
}

Peaks peaks_of(const Trajectory& trajectory, const Bounds& bounds, bool with_jerk) {
  Peaks peaks;
  const JointVec by_v = bounds.v.cwiseInverse(), by_a = bounds.a.cwiseInverse();
  for (std::size_t i = 0; i < trajectory.pieces(); ++i) {
    const Trajectory::Piece piece = trajectory.piece(i);
    const double h = piece.duration;
    const double h2 = h * h, h3 = h2 * h, h4 = h2 * h2;
    for (Eigen::Index r = 0; r < bounds.v.size(); ++r) {
      const auto c = [&](Eigen::Index k) { return piece.c(r, k); };
      const double v[5] = {c(1), 2 * h * c(2), 3 * h2 * c(3), 4 * h3 * c(4), 5 * h4 * c(5)};
      const double a[4] = {2 * c(2), 6 * h * c(3), 12 * h2 * c(4), 20 * h3 * c(5)};
      peaks.v = std::max(peaks.v, peak_of_quartic(v) * by_v[r]);
      if (bound_of_cubic(a) * by_a[r] > peaks.a) {
        peaks.a = std::max(peaks.a, peak_of_cubic(a) * by_a[r]);
      }
      if (!with_jerk) continue;
      const double j[3] = {6 * c(3), 24 * h * c(4), 60 * h2 * c(5)};
      peaks.j = std::max(peaks.j, peak_of_quadratic(j) / bounds.j[r]);
    }
  }
  return peaks;
}

}  // namespace mjarm::detail
