#include "mjarm/path/curve_piece.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mjarm/core/rotation.hpp"
#include "mjarm/path/ellipse.hpp"

namespace mjarm {
namespace {

constexpr double kPi = std::numbers::pi;

/// Angle theta in [0, 2 pi) of the point of the ellipse (a cos, b sin) nearest to (x, y).
/// The nearest point lies in the quadrant of (x, y), and there the derivative of the squared
/// distance changes its sign once: the feet of the normals lie on a hyperbola through the centre
/// and (x, y) that meets the ellipse once in each quadrant it enters with this branch.
double nearest_on_ellipse(double a, double b, double x, double y) {
  const double ax = a * std::abs(x), by = b * std::abs(y), c = (b - a) * (b + a);
  double lower = 0, upper = kPi / 2;
  while (true) {
    const double middle = 0.5 * (lower + upper);
    if (middle <= lower || middle >= upper) break;
    const double s = std::sin(middle), k = std::cos(middle);
    (c * s * k + ax * s - by * k < 0 ? lower : upper) = middle;
  }
  double theta = upper;
  if (x < 0) theta = kPi - theta;
  if (y < 0) theta = -theta;
  return theta < 0 ? theta + 2 * kPi : theta;
}

}  // namespace

Pose CurvePiece::at(double x) const {
  Pose X;
  if (round) {
    const double theta = a == b ? x / a : ellipse_angle(a, b, x);
    const double sin_half = std::sin(0.5 * theta);
    X.p = p0 - 2 * a * sin_half * sin_half * u + b * std::sin(theta) * v;
  } else {
    X.p = p0 + x * u;
  }
  if (rate == 0) {
    X.R = R_ref;
  } else {
    const double d = x - x_ref;
    X.R = R_ref * rotation_exp(d * (w1 + d * (w2 + d * w3)));
  }
  return X;
}

double CurvePiece::nearest(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d d = p - p0;
  if (!round) return std::clamp(u.dot(d), 0.0, span);
  const double x = u.dot(d) + a, y = v.dot(d);  // from the centre
  if (a != b)
    return std::clamp(ellipse_arc_length(a, b, nearest_on_ellipse(a, b, x, y)), 0.0, span);
  const double theta = std::atan2(y, x);
  const double length_there = a * (theta < 0 ? theta + 2 * kPi : theta);
  if (length_there <= span) return length_there;
  const double to_start = (p - at(0).p).squaredNorm(), to_end = (p - at(span).p).squaredNorm();
  return to_end < to_start ? span : 0.0;
}

}  // namespace mjarm
