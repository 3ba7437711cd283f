#include <algorithm>
#include <cmath>

#include "mjarm/trajectory/speed_profile_internal.hpp"

namespace mjarm::detail {
namespace {

/// A bound on the path acceleration and how it changes with u = (ds/dt)^2.
struct Bound {
  double a;
  double by_u;
};

/// A path at one of its grid points.
struct GridPoint {
  const double* d;  // dq/ds of each joint
  const double* e;  // d2q/ds2
};

/// Bounds on the path acceleration a for a given u at one place: at least -at + by u, at most at +
/// by u for each of some rows, and u at most u_max. Upper bounds together are concave in u, lower
/// ones convex. The rows lie in memory of the caller.
class AccelBounds {
 public:
  AccelBounds(double* at, double* by) : at_(at), by_(by) {}
  /// Adds the bounds at a grid point.
  void add_point(const GridPoint& p, const Bounds& bounds, const PathBounds& path_bounds) {
    u_max_ = path_bounds.speed * path_bounds.speed;
    add(1, 0, path_bounds.acceleration);
    for (Eigen::Index j = 0; j < bounds.v.size(); ++j) {
      const double v = bounds.v[j] / std::abs(p.d[j]);
      u_max_ = std::min(u_max_, v * v);
      add(p.d[j], p.e[j], bounds.a[j]);
    }
    close_u();
  }
  /// Adds `start` and the bounds at the end `p` of a cell of length `h` through which a stays
  /// constant.
  void add_cell(const AccelBounds& start, const GridPoint& p, const Bounds& bounds, double h,
                double u_end) {
    std::copy_n(start.at_, start.count_, at_);
    std::copy_n(start.by_, start.count_, by_);
    count_ = start.count_;
    u_max_ = start.u_max_;
    for (Eigen::Index j = 0; j < bounds.v.size(); ++j) {
      add(p.d[j] + 2 * h * p.e[j], p.e[j], start.scale_ * bounds.a[j]);
    }
    add(2 * h, 1, u_end);  // 0 <= u + 2 h a <= u_end
    close_u();
  }
  /// Multiplies all limits: of accelerations, and of u as the square of speeds.
  void scale(double factor) {
    for (int k = 0; k < count_; ++k) at_[k] *= factor;
    u_max_ *= factor;
    scale_ *= factor;
  }

  /// Largest u that leaves some acceleration between the bounds.
  [[nodiscard]] double u_max() const { return u_max_; }
  [[nodiscard]] Bound highest(double u) const {
    Bound best{at_[0] + by_[0] * u, by_[0]};
    for (int k = 1; k < count_; ++k) {
      const double a = at_[k] + by_[k] * u;
      if (a < best.a) best = {a, by_[k]};
    }
    return best;
  }
  [[nodiscard]] Bound lowest(double u) const {
    Bound best{by_[0] * u - at_[0], by_[0]};
    for (int k = 1; k < count_; ++k) {
      const double a = by_[k] * u - at_[k];
      if (a > best.a) best = {a, by_[k]};
    }
    return best;
  }

 private:
  /// |d a + e u| <= limit
  void add(double d, double e, double limit) {
    constexpr double kStill = 1e-10;  // less motion per unit of path does not count
    if (std::abs(d) > kStill) {
      at_[count_] = limit / std::abs(d);
      by_[count_++] = -e / d;
    } else if (e != 0) {
      u_max_ = std::min(u_max_, limit / std::abs(e));
    }
  }
  /// Lowers u_max to where the bounds meet; Newton's method, from above and never below.
  void close_u() {
    for (int k = 0; k <= 2 * count_; ++k) {
      const Bound high = highest(u_max_), low = lowest(u_max_);
      if (low.a <= high.a || low.by_u <= high.by_u) return;
      u_max_ = std::max(u_max_ - (low.a - high.a) / (low.by_u - high.by_u), 0.0);
    }
  }

  double *at_, *by_;
  int count_ = 0;
  double u_max_ = 0;
  double scale_ = 1;
};

/// The same with rows of its own, enough for both ends of a cell.
struct CellBounds {
  double at[2 * kMaxDof + 2], by[2 * kMaxDof + 2];
  AccelBounds bounds{at, by};
};

/// Largest u in [0, `from`] with u + h * bound(u).a <= most, for a convex left side that is below
/// `most` at 0; Newton's method from the right.
template <class Function>
double largest_below(Function bound, double h, double from, double most) {
  double u = from;
  for (int k = 0; k <= 2 * kMaxDof; ++k) {
    const Bound b = bound(u);
    const double over = u + h * b.a - most, slope = 1 + h * b.by_u;
    if (over <= 0 || slope <= 0) break;
    u -= over / slope;
  }
  return std::clamp(u, 0.0, from);
}

/// A grid along a path, and one cell of it after the other in the two passes.
class Grid {
 public:
  Grid(const CubicSpline& spline, std::size_t cells, const Bounds& bounds,
       const PathBounds& path_bounds)
      : spline_(spline), bounds_(bounds) {
    place_points(cells);
    const auto dof = static_cast<std::size_t>(spline.dof());
    const std::size_t n = s_.size(), rows = dof + 1;
    d_.resize(n * dof);
    e_.resize(n * dof);
    at_.resize(n * rows);
    by_.resize(n * rows);
    limits_.reserve(n);
    for (std::size_t i = 0; i < n; ++i) {
      const SplinePoint p = spline.at(s_[i], piece_[i]);
      std::copy_n(p.d.data(), dof, &d_[i * dof]);
      std::copy_n(p.e.data(), dof, &e_[i * dof]);
      limits_.emplace_back(&at_[i * rows], &by_[i * rows]);
      limits_.back().add_point(point(i), bounds, path_bounds);
    }
    for (std::size_t i = 0; i + 1 < n; ++i) constant_.push_back(turns_in(i));
  }
  Grid(const Grid&) = delete;
  Grid& operator=(const Grid&) = delete;

  [[nodiscard]] SpeedProfile fastest() const {
    const std::size_t n = s_.size();
    std::vector<double> u(n, 0.0);  // first the largest from which the end can be reached at rest
    for (std::size_t i = n - 1; i-- > 1;) u[i] = backward(i, u[i + 1]);
    for (std::size_t i = 0; i + 1 < n; ++i) u[i + 1] = forward(i, u[i], u[i + 1]);
    SpeedProfile profile{std::vector<double>(n), s_, std::vector<double>(n), std::vector<double>(n),
                         std::vector<double>(n)};
    for (std::size_t i = 0; i < n; ++i) profile.v[i] = std::sqrt(u[i]);
    for (std::size_t i = 0; i + 1 < n; ++i) fill_cell(i, u[i], u[i + 1], profile);
    return profile;
  }

  /// Lowers the limits where `profile` is beyond them in the middle of a cell.
  void tighten(const SpeedProfile& profile) {
    std::vector<double> factors(s_.size(), 1.0);
    for (std::size_t i = 0; i + 1 < s_.size(); ++i) {
      const double x = 0.5 * (profile.t[i + 1] - profile.t[i]);
      const double jump = 0.5 * (profile.a_before[i + 1] - profile.a_after[i]);
      const double a = profile.a_after[i] + jump;
      const double v = profile.v[i] + x * (profile.a_after[i] + 0.5 * jump);
      const double s = s_[i] + x * (profile.v[i] + x * (0.5 * profile.a_after[i] + jump / 6));
      const SplinePoint p = spline_.at(s, piece_[i]);
      const double over =
          std::max(v * v * p.d.cwiseAbs2().cwiseQuotient(bounds_.v.cwiseAbs2()).maxCoeff(),
                   (a * p.d + v * v * p.e).cwiseAbs().cwiseQuotient(bounds_.a).maxCoeff());
      for (const std::size_t k : {i, i + 1}) factors[k] = std::min(factors[k], 1 / over);
    }
    for (std::size_t i = 0; i < s_.size(); ++i) limits_[i].scale(factors[i]);
  }

 private:
  static constexpr int kParts = 8;  // of the cells at rest, so that time does not leap there

  /// Cells of about one size, all waypoints among their ends.
  void place_points(std::size_t cells) {
    const std::vector<double>& knots = spline_.knots();
    const double largest = (spline_.end() - spline_.start()) / static_cast<double>(cells);
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
      const double length = knots[i + 1] - knots[i];
      const auto count = static_cast<std::size_t>(std::max(2.0, std::ceil(length / largest)));
      for (std::size_t k = 0; k < count; ++k) {
        const bool starts = i == 0 && k == 0, ends = i + 2 == knots.size() && k + 1 == count;
        for (int part = 0; part < (starts || ends ? kParts : 1); ++part) {
          const double share = static_cast<double>(part) / kParts;
          const double within = starts ? share * share : share * (2 - share);
          s_.push_back(knots[i] +
                       length * ((static_cast<double>(k) + within) / static_cast<double>(count)));
          piece_.push_back(i);
        }
      }
    }
    s_.push_back(knots.back());
    piece_.push_back(knots.size() - 2);
  }
  [[nodiscard]] GridPoint point(std::size_t i) const {
    const std::size_t at = i * static_cast<std::size_t>(spline_.dof());
    return {&d_[at], &e_[at]};
  }

  /// True where a joint turns round at about cell `i` and its limit matters. It leaves the
  /// acceleration there nearly free, and one that changes within a cell would swing; so it stays
  /// constant there.
  [[nodiscard]] bool turns_in(std::size_t i) const {
    constexpr double kNear = 2, kMatters = 0.3;
    const GridPoint p = point(i), end = point(i + 1);
    const double h = s_[i + 1] - s_[i];
    const double u = std::max(limits_[i].u_max(), limits_[i + 1].u_max());
    for (Eigen::Index j = 0; j < bounds_.a.size(); ++j) {
      const double e = std::max(std::abs(p.e[j]), std::abs(end.e[j]));
      const double d = std::min(std::abs(p.d[j]), std::abs(end.d[j]));
      if (d < kNear * h * e && e * u > kMatters * bounds_.a[j]) return true;
    }
    return false;
  }

  void fill(CellBounds& cell, std::size_t i, double u_end) const {
    cell.bounds.add_cell(limits_[i], point(i + 1), bounds_, s_[i + 1] - s_[i], u_end);
  }

  /// Largest u at the start of cell `i` that leads to at most `u_end` at its end.
  [[nodiscard]] double backward(std::size_t i, double u_end) const {
    if (constant_[i]) {
      CellBounds cell;
      fill(cell, i, u_end);
      return cell.bounds.u_max();
    }
    const double h = s_[i + 1] - s_[i];
    const double middle = u_end - h * limits_[i + 1].lowest(u_end).a;
    return largest_below([&](double u) { return limits_[i].lowest(u); }, h, limits_[i].u_max(),
                         middle);
  }

  /// Largest u at the end of cell `i`, at most `u_end`, from `u` at its start.
  [[nodiscard]] double forward(std::size_t i, double u, double u_end) const {
    const double h = s_[i + 1] - s_[i];
    if (constant_[i]) {
      CellBounds cell;
      fill(cell, i, u_end);
      return std::clamp(u + 2 * h * cell.bounds.highest(u).a, 0.0, u_end);
    }
    const auto falling = [&](double x) {
      const Bound high = limits_[i + 1].highest(x);
      return Bound{-high.a, -high.by_u};
    };
    return largest_below(falling, h, u_end, u + h * limits_[i].highest(u).a);
  }

  /// Time and accelerations of cell `i`, as even as the limits at its ends allow.
  void fill_cell(std::size_t i, double u, double u_end, SpeedProfile& profile) const {
    const double h = s_[i + 1] - s_[i];
    const double mean = (u_end - u) / (2 * h);
    double half = 0;  // by which the acceleration grows in each half of the cell
    if (!constant_[i]) {
      const double low =
          std::max(limits_[i].lowest(u).a, 2 * mean - limits_[i + 1].highest(u_end).a);
      const double high =
          std::min(limits_[i].highest(u).a, 2 * mean - limits_[i + 1].lowest(u_end).a);
      half = mean - (low <= high ? std::clamp(mean, low, high) : 0.5 * (low + high));
    }
    // h = v T - half T^2 / 6, with v the mean of the speeds at the ends.
    const double v = 0.5 * (profile.v[i] + profile.v[i + 1]);
    double inside = v * v - 2 * half * h / 3;
    if (inside < 0.25 * v * v) {
      half = 0;
      inside = v * v;
    }
    const double time = 2 * h / (v + std::sqrt(inside));
    const double even = (profile.v[i + 1] - profile.v[i]) / time;
    profile.t[i + 1] = profile.t[i] + time;
    profile.a_after[i] = even - half;
    profile.a_before[i + 1] = even + half;
  }

  const CubicSpline& spline_;
  const Bounds& bounds_;
  std::vector<double> s_;
  std::vector<std::size_t> piece_;       // of the spline, after each grid point
  std::vector<double> d_, e_, at_, by_;  // what points and limits refer to
  std::vector<AccelBounds> limits_;
  std::vector<bool> constant_;  // cells
};

}  // namespace

SpeedProfile fastest_profile(const CubicSpline& spline, std::size_t cells, const Bounds& bounds,
                             const PathBounds& path_bounds) {
  Grid grid(spline, cells, bounds, path_bounds);
  grid.tighten(grid.fastest());
  return grid.fastest();
}

}  // namespace mjarm::detail
