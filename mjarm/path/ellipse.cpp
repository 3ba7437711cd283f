#include "mjarm/path/ellipse.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mjarm {
namespace {

using std::numbers::pi;

/// Carlson's R_F and R_D of the same three arguments, by duplication.
struct CarlsonIntegrals {
  double rf;
  double rd;
};

/// x, y >= 0, at most one of them 0; z > 0.
CarlsonIntegrals carlson(double x, double y, double z) {
  constexpr double kSmall = 1e-3;  // both series end at the 6th order: relative error under 1e-17
  double sum = 0;
  double quarter = 1;
  while (true) {
    const double mean_f = (x + y + z) / 3;
    const double mean_d = (x + y + 3 * z) / 5;
    const double spread = std::max({x, y, z}) - std::min({x, y, z});
    if (spread < kSmall * std::min(mean_f, mean_d)) break;
    const double rx = std::sqrt(x), ry = std::sqrt(y), rz = std::sqrt(z);
    const double lambda = rx * ry + ry * rz + rz * rx;
    sum += quarter / (rz * (z + lambda));
    quarter /= 4;
    x = (x + lambda) / 4;
    y = (y + lambda) / 4;
    z = (z + lambda) / 4;
  }
  const double mf = (x + y + z) / 3;
  const double fx = 1 - x / mf, fy = 1 - y / mf, fz = -fx - fy;
  const double e2 = fx * fy - fz * fz, e3 = fx * fy * fz;
  const double rf = (1 - e2 / 10 + e3 / 14 + e2 * e2 / 24 - 3 * e2 * e3 / 44) / std::sqrt(mf);

  const double md = (x + y + 3 * z) / 5;
  const double dx = 1 - x / md, dy = 1 - y / md, dz = -(dx + dy) / 3;
  const double ea = dx * dy, eb = dz * dz;
  const double d2 = ea - 6 * eb, d3 = (3 * ea - 8 * eb) * dz, d4 = 3 * (ea - eb) * eb,
               d5 = ea * eb * dz;
  const double series =
      1 - 3 * d2 / 14 + d3 / 6 + 9 * d2 * d2 / 88 - 3 * d4 / 22 - 9 * d2 * d3 / 52 + 3 * d5 / 26;
  return {rf, 3 * sum + quarter * series / (md * std::sqrt(md))};
}

/// Arc length for |theta| <= pi/2.
double quarter_arc(double a, double b, double theta) {
  const double s = std::sin(theta), c = std::cos(theta);
  const double ratio = a / b;
  const double m = 1 - ratio * ratio;
  // 1 - m s^2, written without cancellation.
  const CarlsonIntegrals e = carlson(c * c, c * c + ratio * ratio * s * s, 1);
  return b * (s * e.rf - m * s * s * s * e.rd / 3);
}

}  // namespace

EllipseAxes ellipse_axes(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d w = normal.stableNormalized();
  const Eigen::Vector3d reference = std::abs(w.x()) > 0.9
                                        ? Eigen::Vector3d(Eigen::Vector3d::UnitY())
                                        : Eigen::Vector3d(Eigen::Vector3d::UnitX());
  const Eigen::Vector3d u = (reference - reference.dot(w) * w).normalized();
  return {u, w.cross(u), w};
}

std::vector<Pose> ellipse_points(const Ellipse& ellipse, int n, bool endpoint) {
  const EllipseAxes axes = ellipse_axes(ellipse.normal);
  std::vector<Pose> points;
  points.reserve(static_cast<std::size_t>(std::max(n, 0)));
  const double step = 2 * pi / std::max(1, endpoint ? n - 1 : n);
  for (int i = 0; i < n; ++i) {
    const double theta = endpoint && i == n - 1 && n > 1 ? 0.0 : i * step;
    points.push_back({ellipse.center + ellipse.a * std::cos(theta) * axes.u +
                          ellipse.b * std::sin(theta) * axes.v,
                      ellipse.R});
  }
  return points;
}

double ellipse_arc_length(double a, double b, double theta) {
  const double turns = std::round(theta / pi);
  const double half = 2 * quarter_arc(a, b, pi / 2);
  return turns * half + quarter_arc(a, b, theta - turns * pi);
}

double ellipse_angle(double a, double b, double length) {
  const double half = 2 * quarter_arc(a, b, pi / 2);
  const double turns = std::round(length / half);
  const double rest = length - turns * half;
  // Newton's method from the proportional guess, kept inside the bracket by bisection.
  double lower = -pi / 2, upper = pi / 2;
  double theta = rest / half * pi;
  for (int i = 0; i < 100; ++i) {
    const double error = quarter_arc(a, b, theta) - rest;
    if (error == 0) break;
    (error > 0 ? upper : lower) = theta;
    const double speed = std::hypot(a * std::sin(theta), b * std::cos(theta));
    double next = theta - error / speed;
    if (!(next > lower && next < upper)) next = 0.5 * (lower + upper);
    if (std::abs(next - theta) <= 1e-16) break;
    theta = next;
  }
  return turns * pi + theta;
}

}  // namespace mjarm
