#include <algorithm>
#include <cmath>
#include <utility>

#include "mjarm/trajectory/accel_bounds_internal.hpp"
#include "mjarm/trajectory/path_torque_internal.hpp"
#include "mjarm/trajectory/speed_profile_internal.hpp"

namespace mjarm::detail {
namespace {

/// A grid along a path, and one cell of it after the other in the two passes.
class Grid {
 public:
  Grid(const CubicSpline& spline, std::size_t cells, const Bounds& bounds,
       const PathBounds& path_bounds)
      : spline_(spline), bounds_(bounds), path_bounds_(path_bounds), dof_(spline.dof()) {
    place_points(cells);
    rows_ = static_cast<std::size_t>(bounds.dynamics ? 2 * dof_ : dof_);
    const std::size_t n = s_.size(), bound_rows = rows_ + 1,
                      interval_rows = bounds.dynamics ? n * rows_ : rows_;
    d_.resize(n * rows_);
    e_.resize(n * rows_);
    low_.resize(interval_rows);
    high_.resize(interval_rows);
    bound_low_.resize(n * bound_rows);
    bound_high_.resize(n * bound_rows);
    bound_by_.resize(n * bound_rows);
    reach_.resize(n);
    u_.resize(n);
    touched_.resize(n);
    limits_.reserve(n);
    for (std::size_t i = 0; i < n; ++i) {
      const SplinePoint p = spline.at(s_[i], piece_[i]);
      set_rows(i, 0, p.d, p.e, -bounds.a, bounds.a);
      if (bounds.dynamics && !add_torques(i, p)) return;
      const std::size_t at = i * bound_rows;
      limits_.emplace_back(&bound_low_[at], &bound_high_[at], &bound_by_[at]);
    }
    set_limits();
  }
  Grid(const Grid&) = delete;
  Grid& operator=(const Grid&) = delete;

  /// Fails where the arm cannot be held still; then there is no motion.
  [[nodiscard]] const Result<void>& held() const { return held_; }

  /// Takes viscous friction as it is at the speeds of `profile`, by a chord of its curve over u.
  void take_friction(const SpeedProfile& profile) {
    constexpr double kLeast = 1e-3;  // of the largest speed; where it rests it does not matter
    const double least = kLeast * *std::max_element(profile.v.begin(), profile.v.end());
    for (std::size_t i = 0; i < s_.size(); ++i) set_friction(i, std::max(profile.v[i], least));
    set_limits();
  }

  /// The fastest motion, found anew only as far as limits have changed since the last time.
  [[nodiscard]] SpeedProfile fastest() {
    const std::size_t n = s_.size();
    const auto update = [](double& value, double now) { return std::exchange(value, now) != now; };
    for (std::size_t i = n - 1; i-- > 1;) {
      if (!touched_[i] && !touched_[i + 1]) continue;
      if (update(reach_[i], backward(i, reach_[i + 1]))) touched_[i] = 1;
    }
    bool moved = false;
    for (std::size_t i = 0; i + 1 < n; ++i) {
      if (!moved && !touched_[i] && !touched_[i + 1]) continue;
      moved = update(u_[i + 1], forward(i, u_[i], reach_[i + 1]));
    }
    std::fill(touched_.begin(), touched_.end(), 0);
    SpeedProfile profile{std::vector<double>(n), s_, std::vector<double>(n), std::vector<double>(n),
                         std::vector<double>(n)};
    for (std::size_t i = 0; i < n; ++i) profile.v[i] = std::sqrt(u_[i]);
    for (std::size_t i = 0; i + 1 < n; ++i) fill_cell(i, u_[i], u_[i + 1], profile);
    return profile;
  }

  /// Lowers the limits where `profile` is beyond them in the middle of a cell.
  void tighten(const SpeedProfile& profile) {
    constexpr double kSlack = 5e-5;  // what is left is for a stretch of the whole
    const JointVec by_v = bounds_.v.cwiseInverse(), by_a = bounds_.a.cwiseInverse();
    std::vector<double> factors(s_.size(), 1.0);
    for (std::size_t i = 0; i + 1 < s_.size(); ++i) {
      const double x = 0.5 * (profile.t[i + 1] - profile.t[i]);
      const double jump = 0.5 * (profile.a_before[i + 1] - profile.a_after[i]);
      const double a = profile.a_after[i] + jump;
      const double v = profile.v[i] + x * (profile.a_after[i] + 0.5 * jump);
      const double s = x * (profile.v[i] + x * (0.5 * profile.a_after[i] + jump / 6));
      const GridPoint p = point(i), end = point(i + 1);
      const double share = s / (s_[i + 1] - s_[i]);
      double over = torque_use(i, a, v * v);
      for (int j = 0; j < dof_; ++j) {
        const double bend = share * (end.e[j] - p.e[j]);
        const double d = p.d[j] + s * (p.e[j] + 0.5 * bend), v_use = v * d * by_v[j];
        over = std::max({over, v_use * v_use, std::abs(a * d + v * v * (p.e[j] + bend)) * by_a[j]});
      }
      if (over <= 1 + kSlack) continue;
      for (const std::size_t k : {i, i + 1}) factors[k] = std::min(factors[k], 1 / over);
    }
    for (std::size_t i = 0; i < s_.size(); ++i) {
      if (factors[i] == 1) continue;
      limits_[i].scale(factors[i]);
      touched_[i] = 1;
    }
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
  /// Where the intervals of a point lie: one for all without torques, as they are the same then.
  [[nodiscard]] std::size_t interval(std::size_t i) const {
    return bounds_.dynamics ? i * rows_ : 0;
  }
  [[nodiscard]] GridPoint point(std::size_t i) const {
    return {&d_[i * rows_], &e_[i * rows_], &low_[interval(i)], &high_[interval(i)], rows_};
  }

  /// Fills the rows of the joints at point `i` from row `first` on.
  void set_rows(std::size_t i, int first, const JointVec& d, const JointVec& e, const JointVec& low,
                const JointVec& high) {
    const auto at = static_cast<std::size_t>(first);
    std::copy_n(d.data(), dof_, &d_[i * rows_ + at]);
    std::copy_n(e.data(), dof_, &e_[i * rows_ + at]);
    std::copy_n(low.data(), dof_, &low_[interval(i) + at]);
    std::copy_n(high.data(), dof_, &high_[interval(i) + at]);
  }

  /// Adds the rows of torques; false where nothing is left of a limit.
  bool add_torques(std::size_t i, const SplinePoint& p) {
    terms_.push_back(torque_terms(bounds_.dynamics, p));
    const TorqueTerms& terms = terms_.back();
    const JointVec creeping = terms.still + terms.dry;
    const double share = (s_[i] - s_.front()) / (s_.back() - s_.front());
    for (const JointVec* torque : {&terms.still, &creeping}) {
      held_ = check_still(*torque, bounds_.torque, share);
      if (!held_) return false;
    }
    set_rows(i, dof_, terms.by_a, terms.by_u, -bounds_.torque - creeping,
             bounds_.torque - creeping);
    for (int j = 0; j < dof_; ++j) {
      const double now = terms.dry[j], before = i > 0 ? terms_[i - 1].dry[j] : now;
      if (before != now && before * now <= 0) {
        const double max = std::max(std::abs(before), std::abs(now));
        free_friction(i - 1, j, max);
        free_friction(i, j, max);
      } else if (i == 0 || i + 1 == s_.size()) {
        free_friction(i, j, std::abs(now));
      }
    }
    inverse_speed_.push_back(0);
    double speed = path_bounds_.speed_at(s_[i]);
    for (int j = 0; j < dof_; ++j) speed = std::min(speed, bounds_.v[j] / std::abs(p.d[j]));
    set_friction(i, speed);
    return true;
  }
  /// Leaves room for dry friction of either sign, up to `max`, at point `i`: where joint `j` turns
  /// round nearby or stands.
  void free_friction(std::size_t i, int j, double max) {
    constexpr double kLeft = 1e-4;  // of the limit, so that there is always a motion
    const std::size_t row = interval(i) + static_cast<std::size_t>(dof_ + j);
    const double still = terms_[i].still[j], least = kLeft * bounds_.torque[j];
    low_[row] = std::min(max - bounds_.torque[j] - still, -least);
    high_[row] = std::max(bounds_.torque[j] - max - still, least);
  }
  /// Viscous friction, which grows with the root of u, as if it grew with u, right at this speed.
  void set_friction(std::size_t i, double speed) {
    const double inverse = 1 / speed;
    for (int j = 0; j < dof_; ++j) {
      e_[i * rows_ + static_cast<std::size_t>(dof_ + j)] +=
          (inverse - inverse_speed_[i]) * terms_[i].viscous[j];
    }
    inverse_speed_[i] = inverse;
  }
  void set_limits() {
    for (std::size_t i = 0; i < s_.size(); ++i) {
      limits_[i].set_point(point(i), bounds_, path_bounds_.acceleration,
                           path_bounds_.speed_at(s_[i]));
    }
    std::fill(touched_.begin(), touched_.end(), 1);
    constant_.clear();
    for (std::size_t i = 0; i + 1 < s_.size(); ++i) constant_.push_back(turns_in(i));
  }

  /// Largest use of a torque limit in the middle of cell `i`, where all terms are about the means
  /// of those at its ends.
  [[nodiscard]] double torque_use(std::size_t i, double a, double u) const {
    const GridPoint p = point(i), q = point(i + 1);
    double max = 0;
    for (auto r = static_cast<std::size_t>(dof_); r < rows_; ++r) {
      const double torque = (p.d[r] + q.d[r]) * a + (p.e[r] + q.e[r]) * u;
      max = std::max(max, torque / (torque > 0 ? p.high[r] + q.high[r] : p.low[r] + q.low[r]));
    }
    return max;
  }

  /// True where a joint turns round at about cell `i` and its limit matters. It leaves the
  /// acceleration there nearly free, and one that changes within a cell would swing; so it stays
  /// constant there.
  [[nodiscard]] bool turns_in(std::size_t i) const {
    constexpr double kNear = 2, kMatters = 0.3;
    const GridPoint p = point(i), end = point(i + 1);
    const double h = s_[i + 1] - s_[i];
    const double u = std::max(limits_[i].u_max(), limits_[i + 1].u_max());
    for (std::size_t r = 0; r < rows_; ++r) {
      const double e = std::max(std::abs(p.e[r]), std::abs(end.e[r]));
      const double d = std::min(std::abs(p.d[r]), std::abs(end.d[r]));
      if (d < kNear * h * e && e * u > kMatters * std::min(p.high[r], -p.low[r])) return true;
    }
    return false;
  }

  void fill(CellBounds& cell, std::size_t i, double u_end) const {
    cell.bounds.add_cell(limits_[i], point(i + 1), s_[i + 1] - s_[i], u_end);
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
  const PathBounds& path_bounds_;
  int dof_;
  std::size_t rows_ = 0;  // of each point
  std::vector<double> s_;
  std::vector<std::size_t> piece_;                         // of the spline, after each grid point
  std::vector<double> d_, e_, low_, high_;                 // what points refer to
  std::vector<double> bound_low_, bound_high_, bound_by_;  // and limits
  std::vector<AccelBounds> limits_;
  std::vector<double> reach_;          // largest u from which the end can be reached at rest
  std::vector<double> u_;              // from rest at the start as well
  std::vector<char> touched_;          // whether limits or `reach_` of a point have changed
  std::vector<bool> constant_;         // cells
  std::vector<TorqueTerms> terms_;     // of each point
  std::vector<double> inverse_speed_;  // for which viscous friction is in `e_`
  Result<void> held_;
};

}  // namespace

Result<SpeedProfile> fastest_profile(const CubicSpline& spline, std::size_t cells,
                                     const Bounds& bounds, const PathBounds& path_bounds) {
  constexpr int kFrictionRounds = 4;
  Grid grid(spline, cells, bounds, path_bounds);
  if (!grid.held()) return fail(grid.held().error());
  SpeedProfile profile = grid.fastest();
  for (int k = 0; bounds.dynamics && k < kFrictionRounds; ++k) {
    grid.take_friction(profile);
    profile = grid.fastest();
  }
  grid.tighten(profile);
  return grid.fastest();
}

}  // namespace mjarm::detail
