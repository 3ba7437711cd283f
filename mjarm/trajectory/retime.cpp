#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mjarm/trajectory/retime_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Second-order model of a sum of terms in (u, u', u'') at one place; lower triangle of the
/// Hessian.
struct Local {
  double g[3] = {0, 0, 0};
  double h[3][3] = {};

  void add(double weight, double curvature, const std::array<double, 3>& gradient) {
    for (std::size_t i = 0; i < 3; ++i) {
      g[i] += weight * gradient[i];
      for (std::size_t j = 0; j <= i; ++j) h[i][j] += curvature * gradient[i] * gradient[j];
    }
  }
};

/// Interior-point method over the coefficients of a quadratic B-spline, of which each cell knows
/// three: its Hessian has five diagonals.
class Solver {
 public:
  explicit Solver(const RetimeProblem& problem)
      : p_(problem), cells_(problem.knots.size() - 1), c_(cells_ + 2) {
    knots_.resize(cells_ + 1);
    for (std::size_t i = 0; i <= cells_; ++i) {
      const double before = i > 0 ? h(i - 1) : 0, after = i < cells_ ? h(i) : 0;
      knots_[i] = {after / (before + after), before / (before + after), 2 / (before + after),
                   0.5 * (before + after)};
    }
  }

  TimeLaw solve() {
    constexpr double kFirst = 1, kLast = 3e-7, kShrink = 0.1;
    constexpr int kSteps = 12;  // for each weight of the barrier at most
    std::fill(c_.begin(), c_.end(), even_start());
    for (double mu = kFirst; mu > kLast; mu *= kShrink) {
      for (int step = 0; step < kSteps && newton(mu); ++step) {
      }
    }
    return law();
  }

 private:
  /// What a knot is made of: u = first c[i] + second c[i+1], u' = slope (c[i+1] - c[i]).
  struct Knot {
    double first, second, slope;
    double weight;  // [s] of time it stands for
  };

  [[nodiscard]] double h(std::size_t cell) const {
    return p_.tau[p_.knots[cell + 1]] - p_.tau[p_.knots[cell]];
  }
  static double u(const std::vector<double>& c, const Knot& k, std::size_t i) {
    return k.first * c[i] + k.second * c[i + 1];
  }
  static double du(const std::vector<double>& c, const Knot& k, std::size_t i) {
    return k.slope * (c[i + 1] - c[i]);
  }

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

  /// Value of the objective with the barrier; infinite where a bound is broken.
  [[nodiscard]] double value(const std::vector<double>& c, double mu) const {
    double sum = 0;
    for (std::size_t i = 0; i <= cells_; ++i) {
      const double at = u(c, knots_[i], i), slope = du(c, knots_[i], i);
      double slack = 1 - at / p_.u_max[i];
      if (!(at > 0) || !(slack > 0)) return kInfinite;
      const double root = std::sqrt(at);
      const std::size_t row = i * p_.a_rows;
      for (std::size_t r = row; r < row + p_.a_rows; ++r) {
        const double a =
            p_.a_a[r] * at + 0.5 * p_.v_a[r] * slope + p_.root_a[r] * root + p_.still[r];
        const double left = 1 - a * a;
        if (!(left > 0)) return kInfinite;
        slack *= left;
      }
      for (const bool after : {false, true}) {
        if (after ? i == cells_ : i == 0) continue;
        const double bend = curvature(c, after ? i : i - 1);
        const std::size_t side = (after ? 2 * i : 2 * i - 1) * p_.rows;
        for (std::size_t r = side; r < side + p_.rows; ++r) {
          const double j =
              root * (p_.j_j[r] * at + 1.5 * p_.a_j[r] * slope + 0.5 * p_.v_j[r] * bend);
          const double left = 1 - j * j;
          if (!(left > 0)) return kInfinite;
          slack *= left;
        }
      }
      sum -= mu * knots_[i].weight * std::log(slack);
      sum += time_weight(i) / root;
      if (i < cells_) {
        const double middle = u_middle(c, i);
        if (!(middle > 0)) return kInfinite;
        sum += 4 * h(i) / 6 / std::sqrt(middle);
      }
    }
    return sum;
  }

  /// Simpson's rule, shared by the knots.
  [[nodiscard]] double time_weight(std::size_t i) const { return knots_[i].weight / 3; }
  [[nodiscard]] double u_middle(const std::vector<double>& c, std::size_t cell) const {
    return 0.5 * (u(c, knots_[cell], cell) + u(c, knots_[cell + 1], cell + 1)) +
           h(cell) / 8 * (du(c, knots_[cell], cell) - du(c, knots_[cell + 1], cell + 1));
  }
  [[nodiscard]] double curvature(const std::vector<double>& c, std::size_t cell) const {
    return (du(c, knots_[cell + 1], cell + 1) - du(c, knots_[cell], cell)) / h(cell);
  }

  /// Adds a local model to the system, given u, u' and u'' there by three neighbouring
  /// coefficients.
  void add(const Local& local, const std::array<std::array<double, 3>, 3>& by, std::size_t first) {
    for (std::size_t a = 0; a < 3; ++a) {
      double sum = 0;
      std::array<double, 3> column{};
      for (std::size_t i = 0; i < 3; ++i) {
        sum += local.g[i] * by[i][a];
        for (std::size_t j = 0; j < 3; ++j) {
          column[i] += (i >= j ? local.h[i][j] : local.h[j][i]) * by[j][a];
        }
      }
      g_[first + a] += sum;
      for (std::size_t b = 0; b <= a; ++b) {
        double entry = 0;
        for (std::size_t i = 0; i < 3; ++i) entry += by[i][b] * column[i];
        hessian_[first + a][a - b] += entry;
      }
    }
  }

  /// Terms at a knot seen from one of its cells: jerks there, and the rest if `all`.
  [[nodiscard]] Local local_at(std::size_t i, bool after, bool all, double mu) const {
    const double at = u(c_, knots_[i], i), slope = du(c_, knots_[i], i);
    const double bend = curvature(c_, after ? i : i - 1);
    const double root = std::sqrt(at), weight = mu * knots_[i].weight;
    Local local;
    const std::size_t side = (after ? 2 * i : 2 * i - 1) * p_.rows;
    for (std::size_t r = side; r < side + p_.rows; ++r) {
      const double by_slope = 1.5 * p_.a_j[r], by_bend = 0.5 * p_.v_j[r];
      const double inner = p_.j_j[r] * at + by_slope * slope + by_bend * bend;
      const double x = root * inner, left = 1 / (1 - x * x);
      local.add(weight * 2 * x * left, weight * 2 * (1 + x * x) * left * left,
                {0.5 * inner / root + root * p_.j_j[r], root * by_slope, root * by_bend});
    }
    if (!all) return local;
    for (std::size_t r = i * p_.a_rows; r < (i + 1) * p_.a_rows; ++r) {
      const double x = p_.a_a[r] * at + 0.5 * p_.v_a[r] * slope + p_.root_a[r] * root + p_.still[r];
      const double left = 1 / (1 - x * x);
      local.add(weight * 2 * x * left, weight * 2 * (1 + x * x) * left * left,
                {p_.a_a[r] + 0.5 * p_.root_a[r] / root, 0.5 * p_.v_a[r], 0});
    }
    const double free = 1 / (p_.u_max[i] - at), time = time_weight(i) / root;
    local.add(weight * free - 0.5 * time / at, weight * free * free + 0.75 * time / (at * at),
              {1, 0, 0});
    return local;
  }

  void build(double mu) {
    g_.assign(cells_ + 2, 0.0);
    hessian_.assign(cells_ + 2, {});
    for (std::size_t k = 0; k < cells_; ++k) {
      const Knot &first = knots_[k], &last = knots_[k + 1];
      const double a = first.slope / h(k), b = last.slope / h(k);
      const std::array<double, 3> bend{a, -a - b, b};
      add(local_at(k, true, true, mu),
          {{{first.first, first.second, 0}, {-first.slope, first.slope, 0}, bend}}, k);
      add(local_at(k + 1, false, k + 1 == cells_, mu),
          {{{0, last.first, last.second}, {0, -last.slope, last.slope}, bend}}, k);
      const double middle = u_middle(c_, k), time = 4 * h(k) / 6 / std::sqrt(middle);
      Local local;
      local.add(-0.5 * time / middle, 0.75 * time / (middle * middle), {1, 0, 0});
      const double part = h(k) / 8;
      add(local,
          {{{0.5 * first.first - part * first.slope,
             0.5 * (first.second + last.first) + part * (first.slope + last.slope),
             0.5 * last.second - part * last.slope},
            {},
            {}}},
          k);
    }
  }

  /// Solves hessian * step = -g by Cholesky's method.
  void solve_banded() {
    const std::size_t n = g_.size();
    step_.assign(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      auto& row = hessian_[i];  // of the factor from here on
      if (i >= 2) row[2] /= hessian_[i - 2][0];
      if (i >= 1) {
        const double twice = i >= 2 ? row[2] * hessian_[i - 1][1] : 0;
        row[1] = (row[1] - twice) / hessian_[i - 1][0];
      }
      row[0] = std::sqrt(std::max(row[0] - row[1] * row[1] - row[2] * row[2], 1e-300));
      double right = -g_[i];
      if (i >= 1) right -= row[1] * step_[i - 1];
      if (i >= 2) right -= row[2] * step_[i - 2];
      step_[i] = right / row[0];
    }
    for (std::size_t i = n; i-- > 0;) {
      if (i + 1 < n) step_[i] -= hessian_[i + 1][1] * step_[i + 1];
      if (i + 2 < n) step_[i] -= hessian_[i + 2][2] * step_[i + 2];
      step_[i] /= hessian_[i][0];
    }
  }

  /// One step; false when there is nothing more to gain.
  bool newton(double mu) {
    constexpr int kHalvings = 30;
    build(mu);
    solve_banded();
    double gain = 0;  // of the linear model for the whole step
    for (std::size_t i = 0; i < c_.size(); ++i) gain -= g_[i] * step_[i];
    const double now = value(c_, mu);
    if (!(gain > 0) || gain < 1e-3 * mu * (p_.tau.back() - p_.tau.front())) return false;
    std::vector<double> trial(c_.size());
    double share = 1;
    for (int k = 0; k < kHalvings; ++k, share *= 0.5) {
      for (std::size_t i = 0; i < c_.size(); ++i) trial[i] = c_[i] + share * step_[i];
      if (value(trial, mu) <= now - 1e-4 * share * gain) {
        c_.swap(trial);
        return true;
      }
    }
    return false;
  }

  [[nodiscard]] TimeLaw law() const {
    // Gauss' rule with five points on [-1, 1].
    constexpr double kNodes[5] = {0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640,
                                  -0.9061798459386640};
    constexpr double kWeights[5] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                                    0.2369268850561891, 0.2369268850561891};
    TimeLaw law{{0}, {u(c_, knots_[0], 0)}, {du(c_, knots_[0], 0)}};
    for (std::size_t k = 0; k < cells_; ++k) {
      const std::size_t first = p_.knots[k], last = p_.knots[k + 1];
      const double at = law.u[first], slope = law.du[first], bend = curvature(c_, k);
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
      law.u.back() = u(c_, knots_[k + 1], k + 1);
      law.du.back() = du(c_, knots_[k + 1], k + 1);
    }
    return law;
  }

  const RetimeProblem& p_;
  std::size_t cells_;
  std::vector<Knot> knots_;
  std::vector<double> c_, g_, step_;
  std::vector<std::array<double, 3>> hessian_;  // row i: diagonal, then one and two to its left
};

}  // namespace

TimeLaw retime(const RetimeProblem& problem) { return Solver(problem).solve(); }

}  // namespace mjarm::detail
