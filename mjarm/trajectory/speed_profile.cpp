#include <algorithm>
#include <array>
#include <cmath>

#include "mjarm/trajectory/speed_profile_internal.hpp"

namespace mjarm::detail {
namespace {

/// A bound on the path acceleration that is linear in u = (ds/dt)^2: at + by * u.
struct Line {
  double at;
  double by;
};

/// All bounds at one grid point: accelerations between the lines, u at most `u_max`.
struct PointBounds {
  std::array<Line, kMaxDof + 2> upper;
  std::array<Line, kMaxDof + 2> lower;
  int count = 0;
  double u_max = 0;

  void add(Line low, Line high) {
    lower[static_cast<std::size_t>(count)] = low;
    upper[static_cast<std::size_t>(count)] = high;
    ++count;
  }
  [[nodiscard]] double highest_acceleration(double u) const {
    double a = upper[0].at + upper[0].by * u;
    for (std::size_t k = 1; k < static_cast<std::size_t>(count); ++k) {
      a = std::min(a, upper[k].at + upper[k].by * u);
    }
    return a;
  }
  /// Largest u <= u_max that leaves some acceleration between the lines.
  [[nodiscard]] double largest_u() const {
    double u = u_max;
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
      for (std::size_t m = 0; m < static_cast<std::size_t>(count); ++m) {
        const double closing = lower[m].by - upper[k].by;
        if (closing > 0) u = std::min(u, (upper[k].at - lower[m].at) / closing);
      }
    }
    return std::max(u, 0.0);
  }
};

PointBounds bounds_at(const JointVec& d, const JointVec& e, const Bounds& bounds,
                      const PathBounds& path_bounds, double slow) {
  constexpr double kStill = 1e-12;  // a joint that moves less per unit of path does not count
  PointBounds point;
  point.u_max = slow * slow * path_bounds.speed * path_bounds.speed;
  point.add({-path_bounds.acceleration, 0}, {path_bounds.acceleration, 0});
  for (Eigen::Index j = 0; j < d.size(); ++j) {
    const double v = slow * bounds.v[j], a = slow * slow * bounds.a[j];
    const double dj = std::abs(d[j]), ej = d[j] < 0 ? -e[j] : e[j];
    if (dj > kStill) {
      point.u_max = std::min(point.u_max, v * v / (dj * dj));
      point.add({-a / dj, -ej / dj}, {a / dj, -ej / dj});
    }
    if (ej != 0) point.u_max = std::min(point.u_max, dj > kStill ? point.u_max : a / std::abs(ej));
  }
  return point;
}

/// Adds: after `step` of path with constant acceleration, u is within [0, u_next].
void add_next(PointBounds& point, double step, double u_next) {
  point.add({0, -0.5 / step}, {0.5 * u_next / step, -0.5 / step});
}

}  // namespace

PathGrid::PathGrid(const CubicSpline& spline) {
  constexpr std::size_t kCells = 1000;  // at least so many, and two between waypoints
  const std::vector<double>& knots = spline.knots();
  const std::size_t pieces = knots.size() - 1;
  const std::size_t cells = std::max<std::size_t>(2, (kCells + pieces - 1) / pieces);
  const auto add = [&](double at) {
    SplinePoint point = spline.at(at);
    s.push_back(at);
    d.push_back(std::move(point.d));
    e.push_back(std::move(point.e));
  };
  for (std::size_t i = 0; i < pieces; ++i) {
    for (std::size_t k = 0; k < cells; ++k) {
      add(knots[i] +
          (knots[i + 1] - knots[i]) * (static_cast<double>(k) / static_cast<double>(cells)));
    }
  }
  add(knots.back());
}

SpeedProfile fastest_profile(const PathGrid& grid, const Bounds& bounds,
                             const PathBounds& path_bounds, const std::vector<double>& slow) {
  const std::size_t n = grid.s.size();
  std::vector<PointBounds> points(n);
  std::vector<double> reachable(n, 0.0);  // largest u from which the end can be reached at rest
  for (std::size_t i = n - 1; i-- > 0;) {
    points[i] = bounds_at(grid.d[i], grid.e[i], bounds, path_bounds, slow[i]);
    add_next(points[i], grid.s[i + 1] - grid.s[i], reachable[i + 1]);
    reachable[i] = points[i].largest_u();
  }
  SpeedProfile profile;
  profile.s = grid.s;
  profile.t.assign(n, 0.0);
  profile.v.assign(n, 0.0);
  double u = 0;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double step = grid.s[i + 1] - grid.s[i];
    u = std::clamp(u + 2 * step * points[i].highest_acceleration(u), 0.0, reachable[i + 1]);
    profile.v[i + 1] = std::sqrt(u);
    profile.t[i + 1] = profile.t[i] + 2 * step / (profile.v[i] + profile.v[i + 1]);
  }
  return profile;
}

}  // namespace mjarm::detail
