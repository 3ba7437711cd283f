#include "mjarm/path/curve_polynomial.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace mjarm {
namespace {

constexpr int kDegree = CurvePolynomial::kDegree;
using Coefficients = CurvePolynomial::Coefficients;

Eigen::Vector3d value(const Coefficients& c, double u) {
  return c.col(0) +
         u * (c.col(1) + u * (c.col(2) + u * (c.col(3) + u * (c.col(4) + u * c.col(5)))));
}
Eigen::Vector3d velocity(const Coefficients& c, double u) {
  return c.col(1) +
         u * (2 * c.col(2) + u * (3 * c.col(3) + u * (4 * c.col(4) + u * (5 * c.col(5)))));
}
Eigen::Vector3d acceleration(const Coefficients& c, double u) {
  return 2 * c.col(2) + u * (6 * c.col(3) + u * (12 * c.col(4) + u * (20 * c.col(5))));
}

/// Arc length between two parameters by the Gauss-Legendre rule of 8 points.
double quadrature(const Coefficients& c, double u0, double u1) {
  constexpr double kNodes[] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                               0.9602898564975363};
  constexpr double kWeights[] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                 0.1012285362903763};
  const double middle = 0.5 * (u0 + u1), half = 0.5 * (u1 - u0);
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    sum += kWeights[i] * (velocity(c, middle - half * kNodes[i]).norm() +
                          velocity(c, middle + half * kNodes[i]).norm());
  }
  return half * sum;
}

/// A polynomial of degree 2 kDegree on an interval, by its Bernstein coefficients: the first and
/// the last are its values at the ends, and all its values lie between the least and the largest
/// one.
using Bernstein = std::array<double, 2 * kDegree + 1>;

double choose(int n, int k) {
  double result = 1;
  for (int i = 1; i <= k; ++i) result = result * (n - k + i) / i;
  return result;
}

/// |p(u) - p|^2 over [0, 1].
Bernstein squared_distance(const Coefficients& c, const Eigen::Vector3d& p) {
  Coefficients b = Coefficients::Zero();  // control points of p(u) - p
  for (int i = 0; i <= kDegree; ++i) {
    for (int j = 0; j <= i; ++j) b.col(i) += choose(i, j) / choose(kDegree, j) * c.col(j);
    b.col(i) -= p;
  }
  Bernstein d{};
  for (int i = 0; i <= kDegree; ++i) {
    for (int j = 0; j <= kDegree; ++j) {
      d[static_cast<std::size_t>(i + j)] += choose(kDegree, i) * choose(kDegree, j) /
                                            choose(2 * kDegree, i + j) * b.col(i).dot(b.col(j));
    }
  }
  return d;
}

struct Interval {
  Bernstein d;
  double u = 0;  // where it begins
  double width = 1;
};

/// The right half of `interval`, which becomes its left half (de Casteljau).
Interval split(Interval& interval) {
  Bernstein left{}, work = interval.d;
  for (std::size_t k = 0; k < work.size(); ++k) {
    left[k] = work[0];
    for (std::size_t i = 0; i + 1 < work.size() - k; ++i) work[i] = 0.5 * (work[i] + work[i + 1]);
  }
  interval.d = left;
  interval.width *= 0.5;
  return {work, interval.u + interval.width, interval.width};
}

enum class Shape { monotone, one_minimum, unknown };

/// What the signs of the first and second differences, hence of the derivatives, prove.
Shape shape_of(const Bernstein& d) {
  bool rises = true, falls = true, convex = true;
  for (std::size_t i = 0; i + 1 < d.size(); ++i) {
    rises = rises && d[i + 1] >= d[i];
    falls = falls && d[i + 1] <= d[i];
    if (i > 0) convex = convex && d[i + 1] - d[i] > d[i] - d[i - 1];
  }
  if (rises || falls) return Shape::monotone;
  return convex ? Shape::one_minimum : Shape::unknown;
}

/// Where (p(u) - p) p'(u) changes its sign in [lower, upper]: Newton's method, else bisection.
double foot(const Coefficients& c, const Eigen::Vector3d& p, double lower, double upper) {
  double u = 0.5 * (lower + upper);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d r = value(c, u) - p, v = velocity(c, u);
    const double g = r.dot(v);
    (g > 0 ? upper : lower) = u;
    double next = u - g / (v.squaredNorm() + r.dot(acceleration(c, u)));
    if (!(next > lower && next < upper)) next = 0.5 * (lower + upper);
    if (std::abs(next - u) <= 1e-16) break;
    u = next;
  }
  return u;
}

}  // namespace

std::optional<CurvePolynomial> CurvePolynomial::create(const Coefficients& c) {
  constexpr double kExact = 1e-14;  // of the length
  CurvePolynomial curve;
  curve.c_ = c;
  curve.panels_.push_back({});
  const double whole = quadrature(c, 0, 1);
  if (!(whole > 0) || !std::isfinite(whole)) return std::nullopt;
  if (!curve.add_panels(0, 1, whole, kExact * whole, 0)) return std::nullopt;
  return curve;
}

/// Halves [u0, u1] until the rule and its two halves agree; a speed that is analytic and away from
/// zero takes a few levels, one that touches zero never ends.
bool CurvePolynomial::add_panels(double u0, double u1, double whole, double tolerance, int depth) {
  constexpr int kDeepest = 14;
  const double middle = 0.5 * (u0 + u1);
  const double left = quadrature(c_, u0, middle), right = quadrature(c_, middle, u1);
  if (std::abs(left + right - whole) <= tolerance) {
    panels_.push_back({u1, panels_.back().s + left + right});
    return true;
  }
  return depth < kDeepest && add_panels(u0, middle, left, tolerance, depth + 1) &&
         add_panels(middle, u1, right, tolerance, depth + 1);
}

double CurvePolynomial::length() const noexcept { return panels_.back().s; }

double CurvePolynomial::parameter(double s) const {
  if (!(s > 0)) return 0;
  if (s >= length()) return 1;
  const auto after = std::upper_bound(panels_.begin() + 1, panels_.end(), s,
                                      [](double x, const Panel& panel) { return x < panel.s; });
  const Panel &first = *(after - 1), &last = *after;
  double lower = first.u, upper = last.u;
  double u = lower + (upper - lower) * (s - first.s) / (last.s - first.s);
  for (int i = 0; i < 100; ++i) {
    const double error = first.s + quadrature(c_, first.u, u) - s;
    (error > 0 ? upper : lower) = u;
    double next = u - error / velocity(c_, u).norm();
    if (!(next > lower && next < upper)) next = 0.5 * (lower + upper);
    if (std::abs(next - u) <= 1e-16) break;
    u = next;
  }
  return u;
}

double CurvePolynomial::arc(double u) const {
  const auto after = std::upper_bound(panels_.begin() + 1, panels_.end() - 1, u,
                                      [](double x, const Panel& panel) { return x < panel.u; });
  return (after - 1)->s + quadrature(c_, (after - 1)->u, u);
}

Eigen::Vector3d CurvePolynomial::at(double s) const { return value(c_, parameter(s)); }

Eigen::Vector3d CurvePolynomial::direction(double s) const {
  return velocity(c_, parameter(s)).normalized();
}

/// Branch and bound from left to right: an interval is left as soon as its least Bernstein
/// coefficient shows that it holds nothing nearer, or its shape is proved.
double CurvePolynomial::nearest(const Eigen::Vector3d& p, double within) const {
  constexpr double kRounding = 1e-12;   // of the squared distance
  constexpr double kNarrowest = 1e-12;  // of the curve
  if (!p.allFinite()) return 0;
  double best = within * within, u_best = 0;
  const auto offer = [&](double u) {
    const double d = (value(c_, u) - p).squaredNorm();
    if (d < best) {
      best = d;
      u_best = u;
    }
  };
  std::vector<Interval> open{{squared_distance(c_, p)}};
  if (*std::min_element(open[0].d.begin(), open[0].d.end()) >= best) return 0;
  offer(0);
  offer(1);
  while (!open.empty()) {
    Interval interval = open.back();
    open.pop_back();
    const double least = *std::min_element(interval.d.begin(), interval.d.end());
    if (least >= best * (1 - kRounding)) continue;
    const Shape shape = shape_of(interval.d);
    if (shape == Shape::one_minimum) offer(foot(c_, p, interval.u, interval.u + interval.width));
    if (shape != Shape::unknown || interval.width < kNarrowest) continue;
    open.push_back(split(interval));
    offer(open.back().u);
    open.push_back(interval);
  }
  return arc(u_best);
}

}  // namespace mjarm
