#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "mjarm/trajectory/retime_internal.hpp"
#include "mjarm/trajectory/retime_lanes_internal.hpp"

namespace mjarm::detail {
namespace {

/// A problem laid out for the kernels, in memory of its own.
class Layout {
 public:
  explicit Layout(const RetimeProblem& problem) : p_(problem) {
    const std::size_t n = p_.knots.size();
    constexpr std::size_t kWidest = RetimeLanes::kWidest;
    lanes_.stride = (n + kWidest - 1) / kWidest * kWidest;
    lanes_.rows = p_.rows;
    lanes_.a_rows = p_.a_rows;
    const auto is_zero = [](double x) { return x == 0; };
    lanes_.rests =
        !std::ranges::all_of(p_.root_a, is_zero) || !std::ranges::all_of(p_.still, is_zero);
    add_columns();
    add_knots();
    add_rows();
  }
  Layout(const Layout&) = delete;
  Layout& operator=(const Layout&) = delete;

  RetimeLanes& lanes() { return lanes_; }
  const RetimeLanes& lanes() const { return lanes_; }

 private:
  void add_columns() {
    RetimeLanes& l = lanes_;
    std::vector<std::pair<double**, std::size_t>> columns;
    for (double** one : {&l.first, &l.second, &l.slope, &l.weight, &l.by_u_max, &l.before, &l.after,
                         &l.eighth, &l.middle_time, &l.u, &l.du}) {
      columns.emplace_back(one, 1);
    }
    for (double*& one : l.g) columns.emplace_back(&one, 1);
    for (double*& one : l.diagonal) columns.emplace_back(&one, 1);
    for (double*& one : l.next) columns.emplace_back(&one, 1);
    for (double*& one : l.skip) columns.emplace_back(&one, 1);
    for (double** many : {&l.a_a, &l.v_a, &l.root_a, &l.still})
      columns.emplace_back(many, l.a_rows);
    for (double** many :
         {&l.j_after, &l.a_after, &l.v_after, &l.j_before, &l.a_before, &l.v_before}) {
      columns.emplace_back(many, l.rows);
    }
    std::size_t size = 0;
    for (const auto& [column, rows] : columns) size += rows * l.stride + 2 * RetimeLanes::kRoom;
    memory_.assign(size, 0.0);
    double* next = memory_.data();
    for (const auto& [column, rows] : columns) {
      *column = next + RetimeLanes::kRoom;
      next += rows * l.stride + 2 * RetimeLanes::kRoom;
    }
  }

  [[nodiscard]] double h(std::size_t cell) const {
    return p_.tau[p_.knots[cell + 1]] - p_.tau[p_.knots[cell]];
  }

  void add_knots() {
    const std::size_t cells = p_.knots.size() - 1;
    // Knots that fill up stand at u = 1 and weigh nothing.
    std::fill_n(lanes_.first, lanes_.stride, 0.5);
    std::fill_n(lanes_.second, lanes_.stride, 0.5);
    for (std::size_t i = 0; i <= cells; ++i) {
      const double before = i > 0 ? h(i - 1) : 0, after = i < cells ? h(i) : 0;
      lanes_.first[i] = after / (before + after);
      lanes_.second[i] = before / (before + after);
      lanes_.slope[i] = 2 / (before + after);
      lanes_.weight[i] = 0.5 * (before + after);
      lanes_.by_u_max[i] = 1 / p_.u_max[i];
      if (i > 0) lanes_.before[i] = 1 / before;
      if (i == cells) continue;
      lanes_.after[i] = 1 / after;
      lanes_.eighth[i] = after / 8;
      lanes_.middle_time[i] = 4 * after / 6;
    }
  }

  void add_rows() {
    const std::size_t knots = p_.knots.size();
    for (std::size_t i = 0; i < knots; ++i) {
      for (std::size_t r = 0; r < p_.a_rows; ++r) {
        const std::size_t from = i * p_.a_rows + r, to = r * lanes_.stride + i;
        lanes_.a_a[to] = p_.a_a[from];
        lanes_.v_a[to] = 0.5 * p_.v_a[from];
        lanes_.root_a[to] = p_.root_a[from];
        lanes_.still[to] = p_.still[from];
      }
      for (std::size_t r = 0; r < p_.rows; ++r) {
        const std::size_t to = r * lanes_.stride + i;
        if (i + 1 < knots) {
          const std::size_t from = 2 * i * p_.rows + r;
          lanes_.j_after[to] = p_.j_j[from];
          lanes_.a_after[to] = 1.5 * p_.a_j[from];
          lanes_.v_after[to] = 0.5 * p_.v_j[from];
        }
        if (i == 0) continue;
        const std::size_t from = (2 * i - 1) * p_.rows + r;
        lanes_.j_before[to] = p_.j_j[from];
        lanes_.a_before[to] = 1.5 * p_.a_j[from];
        lanes_.v_before[to] = 0.5 * p_.v_j[from];
      }
    }
  }

  const RetimeProblem& p_;
  RetimeLanes lanes_{};
  std::vector<double> memory_;
};

/// Interior-point method over the coefficients of a quadratic B-spline, of which each cell knows
/// three: its Hessian has five diagonals.
class Solver {
 public:
  explicit Solver(const RetimeProblem& problem)
      : p_(problem),
        layout_(problem),
        kernels_(retime_kernels()),
        cells_(problem.knots.size() - 1),
        c_(layout_.lanes().stride + RetimeLanes::kRoom, 1.0),
        trial_(c_),
        g_(cells_ + 2),
        step_(cells_ + 2),
        hessian_(cells_ + 2) {}

  TimeLaw solve() {
    constexpr double kFirst = 1, kLast = 3e-7, kShrink = 0.1;
    constexpr int kSteps = 12;  // for each weight of the barrier at most
    std::fill_n(c_.begin(), cells_ + 2, even_start());
    for (double mu = kFirst; mu > kLast; mu *= kShrink) {
      value_ = kernels_.value(layout_.lanes(), c_.data(), mu);
      for (int step = 0; step < kSteps && newton(mu); ++step) {
      }
    }
    return law();
  }

 private:
  /// An even u that is well within all bounds.
  [[nodiscard]] double even_start() const {
    double least = *std::min_element(p_.u_max.begin(), p_.u_max.end());
    for (std::size_t r = 0; r < p_.a_a.size(); ++r) {
      const double left = 1 - std::abs(p_.still[r]), by_root = 0.5 * left / p_.root_a[r];
      least = std::min({least, left / std::abs(p_.a_a[r]), by_root * by_root});
    }
    for (const double j : p_.j_j) least = std::min(least, std::pow(std::abs(j), -2. / 3));
    return 0.5 * least;
  }

  /// Puts what the knots about each coefficient say of it together.
  void build(double mu) {
    kernels_.model(layout_.lanes(), c_.data(), mu);
    const RetimeLanes& l = layout_.lanes();
    // Knot i knows coefficients i - 1 to i + 2; there is none before the first.
    for (std::size_t m = 0; m < g_.size(); ++m) {
      g_[m] = l.g[0][m + 1] + l.g[1][m];
      auto& row = hessian_[m];
      row = {l.diagonal[0][m + 1] + l.diagonal[1][m], 0, 0};
      if (m >= 1) {
        g_[m] += l.g[2][m - 1];
        row[0] += l.diagonal[2][m - 1];
        row[1] = l.next[0][m] + l.next[1][m - 1];
        row[2] = l.skip[0][m - 1];
      }
      if (m < 2) continue;
      g_[m] += l.g[3][m - 2];
      row[0] += l.diagonal[3][m - 2];
      row[1] += l.next[2][m - 2];
      row[2] += l.skip[1][m - 2];
    }
  }

  /// Solves hessian * step = -g by Cholesky's method, L D L^T: one division a row.
  void solve_banded() {
    const std::size_t n = g_.size();
    for (std::size_t i = 0; i < n; ++i) {
      auto& row = hessian_[i];  // from here on 1 / D, and L to its left
      const double second = row[2], first = i >= 2 ? row[1] - hessian_[i - 1][1] * second : row[1];
      double right = -g_[i];
      if (i >= 2) {
        row[2] = second * hessian_[i - 2][0];
        row[0] -= row[2] * second;
        right -= row[2] * step_[i - 2];
      }
      if (i >= 1) {
        row[1] = first * hessian_[i - 1][0];
        row[0] -= row[1] * first;
        right -= row[1] * step_[i - 1];
      }
      row[0] = 1 / std::max(row[0], 1e-300);
      step_[i] = right;
    }
    for (std::size_t i = n; i-- > 0;) {
      step_[i] *= hessian_[i][0];
      if (i + 1 < n) step_[i] -= hessian_[i + 1][1] * step_[i + 1];
      if (i + 2 < n) step_[i] -= hessian_[i + 2][2] * step_[i + 2];
    }
  }

  /// One step; false when there is nothing more to gain.
  bool newton(double mu) {
    constexpr int kHalvings = 30;
    build(mu);
    solve_banded();
    double gain = 0;  // of the linear model for the whole step
    for (std::size_t i = 0; i < g_.size(); ++i) gain -= g_[i] * step_[i];
    if (!(gain > 0) || gain < 1e-3 * mu * (p_.tau.back() - p_.tau.front())) return false;
    double share = 1;
    for (int k = 0; k < kHalvings; ++k, share *= 0.5) {
      for (std::size_t i = 0; i < step_.size(); ++i) trial_[i] = c_[i] + share * step_[i];
      const double value = kernels_.value(layout_.lanes(), trial_.data(), mu);
      if (!(value <= value_ - 1e-4 * share * gain)) continue;
      c_.swap(trial_);
      value_ = value;
      return true;
    }
    return false;
  }

  /// u, u' at knot `i`, and u'' of cell `i`.
  [[nodiscard]] double u(std::size_t i) const {
    return layout_.lanes().first[i] * c_[i] + layout_.lanes().second[i] * c_[i + 1];
  }
  [[nodiscard]] double du(std::size_t i) const {
    return layout_.lanes().slope[i] * (c_[i + 1] - c_[i]);
  }
  [[nodiscard]] double curvature(std::size_t i) const {
    return (du(i + 1) - du(i)) * layout_.lanes().after[i];
  }

  [[nodiscard]] TimeLaw law() const {
    // Gauss' rule with five points on [-1, 1].
    constexpr double kNodes[5] = {0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640,
                                  -0.9061798459386640};
    constexpr double kWeights[5] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                                    0.2369268850561891, 0.2369268850561891};
    TimeLaw law{{0}, {u(0)}, {du(0)}};
    for (std::size_t k = 0; k < cells_; ++k) {
      const std::size_t first = p_.knots[k], last = p_.knots[k + 1];
      const double at = law.u[first], slope = law.du[first], bend = curvature(k);
      double from = 0;
      for (std::size_t i = first + 1; i <= last; ++i) {
        const double to = p_.tau[i] - p_.tau[first], half = 0.5 * (to - from);
        double time = 0;
        for (std::size_t m = 0; m < 5; ++m) {
          const double x = from + half * (1 + kNodes[m]);
          time += half * kWeights[m] / std::sqrt(at + x * (slope + 0.5 * bend * x));
        }
        law.t.push_back(law.t.back() + time);
        law.u.push_back(at + to * (slope + 0.5 * bend * to));
        law.du.push_back(slope + bend * to);
        from = to;
      }
      law.u.back() = u(k + 1);
      law.du.back() = du(k + 1);
    }
    return law;
  }

  const RetimeProblem& p_;
  Layout layout_;
  RetimeKernels kernels_;
  std::size_t cells_;
  std::vector<double> c_, trial_;  // as long as kernels read
  std::vector<double> g_, step_;
  std::vector<std::array<double, 3>> hessian_;  // row i: diagonal, then one and two to its left
  double value_ = 0;                            // at c_
};

}  // namespace

TimeLaw retime(const RetimeProblem& problem) { return Solver(problem).solve(); }

}  // namespace mjarm::detail
