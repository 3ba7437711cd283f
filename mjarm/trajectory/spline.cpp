#include <algorithm>

#include "mjarm/trajectory/spline_internal.hpp"

namespace mjarm::detail {

CubicSpline::CubicSpline(std::span<const double> s, std::span<const JointVec> q, SplineEnds ends)
    : s_(s.begin(), s.end()), q_(q.begin(), q.end()), e_(s.size(), JointVec::Zero(q[0].size())) {
  const std::size_t n = s_.size();
  if (n == 2) return;
  const auto h = [&](std::size_t i) { return s_[i + 1] - s_[i]; };
  const auto slope = [&](std::size_t i) -> JointVec { return (q_[i + 1] - q_[i]) / h(i); };
  const bool natural = ends == SplineEnds::natural;
  if (n == 3 && !natural) {
    const JointVec e = 2 * (slope(1) - slope(0)) / (h(0) + h(1));
    e_.assign(3, e);
    return;
  }
  // Rows 1 to n-2 of the usual tridiagonal system; the end values are put in by the conditions at
  // the ends. Thomas' algorithm; the rows are diagonally dominant or bidiagonal at the ends.
  std::vector<double> above(n, 0.0);  // of the eliminated system
  for (std::size_t i = 1; i + 1 < n; ++i) {
    double lower = h(i - 1), diagonal = 2 * (h(i - 1) + h(i)), upper = h(i);
    if (i == 1) {
      if (!natural) {
        diagonal += h(0) * (1 + h(0) / h(1));
        upper -= h(0) * h(0) / h(1);
      }
      lower = 0;
    }
    if (i == n - 2) {
      if (!natural) {
        diagonal += h(i) * (1 + h(i) / h(i - 1));
        lower -= h(i) * h(i) / h(i - 1);
      }
      upper = 0;
    }
    const double pivot = diagonal - lower * above[i - 1];
    above[i] = upper / pivot;
    const JointVec right = 6 * (slope(i) - slope(i - 1)) - lower * e_[i - 1];
    e_[i] = right / pivot;
  }
  for (std::size_t i = n - 2; i-- > 1;) e_[i] -= above[i] * e_[i + 1];
  if (natural) return;
  e_[0] = e_[1] + (e_[1] - e_[2]) * (h(0) / h(1));
  e_[n - 1] = e_[n - 2] + (e_[n - 2] - e_[n - 3]) * (h(n - 2) / h(n - 3));
}

std::size_t CubicSpline::piece(double s) const {
  const auto after = std::upper_bound(s_.begin() + 1, s_.end() - 1, s);
  return static_cast<std::size_t>(after - s_.begin()) - 1;
}

SplinePoint CubicSpline::at(double s, std::size_t i) const {
  const double h = s_[i + 1] - s_[i];
  const double x = std::clamp(s - s_[i], 0.0, h), y = h - x;
  // Written about both ends, so that the waypoints are met exactly.
  const double inverse = 1 / h, left = y / h, right = x / h, sixth = inverse / 6;
  const double q_left = x * y * sixth * (h + y), q_right = x * y * sixth * (h + x);
  const double d_left = (h * h - 3 * y * y) * sixth, d_right = (3 * x * x - h * h) * sixth;
  const Eigen::Index dof = q_[i].size();
  SplinePoint p{JointVec(dof), JointVec(dof), JointVec(dof), JointVec(dof)};
  for (Eigen::Index j = 0; j < dof; ++j) {
    const double q0 = q_[i][j], q1 = q_[i + 1][j], e0 = e_[i][j], e1 = e_[i + 1][j];
    p.q[j] = left * q0 + right * q1 - (q_left * e0 + q_right * e1);
    p.d[j] = (q1 - q0) * inverse + d_left * e0 + d_right * e1;
    p.e[j] = left * e0 + right * e1;
    p.f[j] = (e1 - e0) * inverse;
  }
  return p;
}

}  // namespace mjarm::detail
