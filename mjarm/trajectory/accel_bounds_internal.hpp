#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/trajectory/limits_internal.hpp"
#include "mjarm/trajectory/speed_profile_internal.hpp"

namespace mjarm::detail {

/// A bound on the path acceleration and how it changes with u = (ds/dt)^2.
struct Bound {
  double a;
  double by_u;
};

/// What holds at one grid point: low <= d a + e u <= high in each of some rows, low < 0 < high. The
/// first are the accelerations of the joints, d = dq/ds and e = d2q/ds2; then come their torques.
struct GridPoint {
  const double *d, *e, *low, *high;
  std::size_t rows;
};

/// Bounds on the path acceleration a for a given u at one place: at least low + by u, at most high
/// + by u for each of some rows, and u at most u_max. Upper bounds together are concave in u, lower
/// ones convex. The rows lie in memory of the caller.
class AccelBounds {
 public:
  AccelBounds(double* low, double* high, double* by) : low_(low), high_(high), by_(by) {}
  /// The bounds at a grid point.
  void set_point(const GridPoint& p, const Bounds& bounds, double path_acceleration,
                 double path_speed) {
    count_ = 0;
    scale_ = 1;
    u_max_ = path_speed * path_speed;
    add(1, 0, -path_acceleration, path_acceleration);
    for (Eigen::Index j = 0; j < bounds.v.size(); ++j) {
      const double v = bounds.v[j] / std::abs(p.d[j]);
      u_max_ = std::min(u_max_, v * v);
    }
    for (std::size_t r = 0; r < p.rows; ++r) add(p.d[r], p.e[r], p.low[r], p.high[r]);
    close_u();
  }
  /// Adds `start` and the bounds at the end `p` of a cell of length `h` through which a stays
  /// constant.
  void add_cell(const AccelBounds& start, const GridPoint& p, double h, double u_end) {
    std::copy_n(start.low_, start.count_, low_);
    std::copy_n(start.high_, start.count_, high_);
    std::copy_n(start.by_, start.count_, by_);
    count_ = start.count_;
    u_max_ = start.u_max_;
    for (std::size_t r = 0; r < p.rows; ++r) {
      add(p.d[r] + 2 * h * p.e[r], p.e[r], start.scale_ * p.low[r], start.scale_ * p.high[r]);
    }
    add(2 * h, 1, -u_end, u_end);  // 0 <= u + 2 h a <= u_end
    close_u();
  }
  /// Multiplies all limits: of accelerations and torques, and of u as the square of speeds.
  void scale(double factor) {
    for (int k = 0; k < count_; ++k) {
      low_[k] *= factor;
      high_[k] *= factor;
    }
    u_max_ *= factor;
    scale_ *= factor;
  }

  /// Largest u that leaves some acceleration between the bounds.
  [[nodiscard]] double u_max() const { return u_max_; }
  [[nodiscard]] Bound highest(double u) const {
    Bound best{high_[0] + by_[0] * u, by_[0]};
    for (int k = 1; k < count_; ++k) {
      const double a = high_[k] + by_[k] * u;
      if (a < best.a) best = {a, by_[k]};
    }
    return best;
  }
  [[nodiscard]] Bound lowest(double u) const {
    Bound best{low_[0] + by_[0] * u, by_[0]};
    for (int k = 1; k < count_; ++k) {
      const double a = low_[k] + by_[k] * u;
      if (a > best.a) best = {a, by_[k]};
    }
    return best;
  }

 private:
  /// low <= d a + e u <= high
  void add(double d, double e, double low, double high) {
    constexpr double kStill = 1e-10;  // less motion per unit of path does not count
    if (std::abs(d) > kStill) {
      const double inverse = 1 / d;
      low_[count_] = (d > 0 ? low : high) * inverse;
      high_[count_] = (d > 0 ? high : low) * inverse;
      by_[count_++] = -e * inverse;
    } else if (e != 0) {
      u_max_ = std::min(u_max_, (e > 0 ? high : low) / e);
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

  double *low_, *high_, *by_;
  int count_ = 0;
  double u_max_ = 0;
  double scale_ = 1;
};

/// The same with rows of its own, enough for both ends of a cell.
struct CellBounds {
  static constexpr int kMax = 4 * kMaxDof + 2;
  double low[kMax], high[kMax], by[kMax];
  AccelBounds bounds{low, high, by};
};

/// Largest u in [0, `from`] with u + h * bound(u).a <= most, for a convex left side that is below
/// `max` at 0; Newton's method from the right.
template <class Function>
double largest_below(Function bound, double h, double from, double max) {
  double u = from, solved = 0;  // the slope of the row that was solved for last
  for (int k = 0; k <= 2 * kMaxDof; ++k) {
    const Bound b = bound(u);
    const double over = u + h * b.a - max, slope = 1 + h * b.by_u;
    if (over <= 0 || slope <= 0 || (k > 0 && b.by_u == solved)) break;
    u -= over / slope;
    solved = b.by_u;
  }
  return std::clamp(u, 0.0, from);
}

}  // namespace mjarm::detail
