#include "mjarm/path/curve_piece.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mjarm/core/rotation.hpp"
#include "mjarm/path/ellipse.hpp"

namespace mjarm {
namespace {

using std::numbers::pi;

/// Angle theta in [0, 2 pi) of the point of the ellipse (a cos, b sin) nearest to (x, y).
/// The nearest point lies in the quadrant of (x, y), and there the derivative of the squared
/// distance changes its sign once: the feet of the normals lie on a hyperbola through the centre
/// and (x, y) that meets the ellipse once in each quadrant it enters with this branch.
double nearest_on_ellipse(double a, double b, double x, double y) {
  const double ax = a * std::abs(x), by = b * std::abs(y), c = (b - a) * (b + a);
  double lower = 0, upper = pi / 2;
  while (true) {
    const double middle = 0.5 * (lower + upper);
    if (middle <= lower || middle >= upper) break;
    const double s = std::sin(middle), k = std::cos(middle);
    (c * s * k + ax * s - by * k < 0 ? lower : upper) = middle;
  }
  double theta = upper;
  if (x < 0) theta = pi - theta;
  if (y < 0) theta = -theta;
  return theta < 0 ? theta + 2 * pi : theta;
}

/// Jr(w) v: the rate of R = exp(w), axes of R, where w changes at the rate v.
Eigen::Vector3d right_jacobian(const Eigen::Vector3d& w, const Eigen::Vector3d& v) {
  const double t = w.norm();
  const double c1 = t < 1e-3 ? 0.5 - t * t / 24 : (1 - std::cos(t)) / (t * t);
  const double c2 = t < 1e-3 ? 1.0 / 6 - t * t / 120 : (t - std::sin(t)) / (t * t * t);
  const Eigen::Vector3d wv = w.cross(v);
  return v - c1 * wv + c2 * w.cross(wv);
}

/// The v with Jr(w) v = `rate`, |w| <= pi.
Eigen::Vector3d inverse_right_jacobian(const Eigen::Vector3d& w, const Eigen::Vector3d& rate) {
  const double t = w.norm();
  const double c = t < 1e-3 ? 1.0 / 12 + t * t / 720
                            : (1 - 0.5 * t * std::cos(0.5 * t) / std::sin(0.5 * t)) / (t * t);
  const Eigen::Vector3d wr = w.cross(rate);
  return rate + 0.5 * wr + c * w.cross(wr);
}

}  // namespace

void CurvePiece::set_turn(const Eigen::Matrix3d& R0, const Eigen::Matrix3d& R1,
                          const Eigen::Vector3d& rate0, const Eigen::Vector3d& rate1) {
  const Eigen::Vector3d w = rotation_log(R0.transpose() * R1);
  const Eigen::Vector3d secant = w / span, slope1 = inverse_right_jacobian(w, rate1);
  R_ref = R0;
  x_ref = 0;
  w1 = rate0;
  w2 = (3 * secant - 2 * rate0 - slope1) / span;
  w3 = (rate0 + slope1 - 2 * secant) / (span * span);
  turn = w.norm();
  // |R's rate| <= |w'|, and w' lies between its Bernstein coefficients.
  rate = std::max({rate0.norm(), (rate0 + span * w2).norm(), slope1.norm()});
}

Pose CurvePiece::at(double x) const {
  Pose X;
  if (bend) {
    X.p = p0 + bend->at(x);
  } else if (round) {
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

Eigen::Vector3d CurvePiece::direction(double x) const {
  if (bend) return bend->direction(x);
  if (!round) return u;
  const double theta = a == b ? x / a : ellipse_angle(a, b, x);
  return (-a * std::sin(theta) * u + b * std::cos(theta) * v).normalized();
}

Eigen::Vector3d CurvePiece::turn_rate(double x) const {
  const double d = x - x_ref;
  return right_jacobian(d * (w1 + d * (w2 + d * w3)), w1 + d * (2 * w2 + d * (3 * w3)));
}

double CurvePiece::nearest(const Eigen::Vector3d& p, double within) const {
  const Eigen::Vector3d d = p - p0;
  if (bend) return bend->nearest(d, within);
  if (!round) return std::clamp(u.dot(d), 0.0, span);
  const double x = u.dot(d) + a, y = v.dot(d);  // from the centre
  if (a != b)
    return std::clamp(ellipse_arc_length(a, b, nearest_on_ellipse(a, b, x, y)), 0.0, span);
  const double theta = std::atan2(y, x);
  const double length_there = a * (theta < 0 ? theta + 2 * pi : theta);
  if (length_there <= span) return length_there;
  const double to_start = (p - at(0).p).squaredNorm(), to_end = (p - at(span).p).squaredNorm();
  return to_end < to_start ? span : 0.0;
}

}  // namespace mjarm
