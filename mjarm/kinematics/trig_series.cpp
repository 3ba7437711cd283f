#include <algorithm>
#include <cmath>
#include <numbers>

#include "mjarm/kinematics/trig_internal.hpp"
#include "mjarm/kinematics/trig_series_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr int kGrid = 128;
constexpr double kGridStep = 2 * std::numbers::pi / kGrid;
constexpr int kTerms = 2 * TrigSeries::kDegree + 1;
constexpr double kFirstSample = 0.1;  // [rad]
constexpr int kHalvings = 8;          // of a cell, at most
constexpr double kMissed = 0.05;      // share of f that a cubic may miss in the middle of a cell
constexpr int kMostSteps = 60;
constexpr double kSameRoot = 1e-12;  // [rad]

/// 1, cos x, ..., cos 8x, sin x, ..., sin 8x where a series is made, and on the grid where its
/// roots are looked for.
struct TrigTables {
  double samples[TrigSeries::kSamples][kTerms];
  double grid[kTerms][kGrid];

  TrigTables() noexcept {
    for (int t = 0; t < kTerms; ++t) {
      for (int j = 0; j < TrigSeries::kSamples; ++j) samples[j][t] = term(t, TrigSeries::sample(j));
      for (int j = 0; j < kGrid; ++j) grid[t][j] = term(t, kGridStep * j);
    }
  }

 private:
  static double term(int t, double x) noexcept {
    const int k = t <= TrigSeries::kDegree ? t : t - TrigSeries::kDegree;
    double s = 0, c = 0;
    sin_cos_inside(k * x, s, c);
    return t <= TrigSeries::kDegree ? c : s;
  }
};

const TrigTables& trig_tables() noexcept {
  static const TrigTables tables;
  return tables;
}

struct GraphPoint {
  double x, f, slope;
};

bool differ(double a, double b) noexcept { return (a < 0) != (b < 0); }

/// Of the cubic with the values and slopes of both ends.
double middle_of_cubic(const GraphPoint& a, const GraphPoint& b) noexcept {
  return 0.5 * (a.f + b.f) + 0.125 * (b.x - a.x) * (a.slope - b.slope);
}

/// True where there may be roots between two points that their signs and slopes do not show: where
/// the cubic between them is off by `miss` in the middle, which is much beside f; or where it is
/// not monotone though both slopes have one sign (F. N. Fritsch and R. E. Carlson, SIAM J. Numer.
/// Anal. 17 (1980) 238).
bool may_hide(const GraphPoint& a, const GraphPoint& b, double miss) noexcept {
  if (miss > kMissed * std::min(std::abs(a.f), std::abs(b.f))) return true;
  if (differ(a.slope, b.slope)) return false;
  const double mean = (b.f - a.f) / (b.x - a.x);
  const double steepest = std::max(std::abs(a.slope), std::abs(b.slope));
  return steepest > 3 * std::abs(mean) || differ(mean, a.slope);
}

/// Looks for the roots of a series, cell by cell.
class RootScan {
 public:
  /// `least`: an extremum of so little is a root.
  RootScan(const TrigSeries& series, double least, TrigSeries::Root* out) noexcept
      : series_(series), least_(least), out_(out) {}

  /// In halves, as often as it takes. What is too small for that may hide anything.
  void hard_cell(const GraphPoint& a, const GraphPoint& b, int halvings) noexcept {
    const GraphPoint middle = point(0.5 * (a.x + b.x));
    if (std::max(std::abs(a.f), std::abs(b.f)) <= least_) {
      add({middle.x, 0.5 * (b.x - a.x)});
    } else if (halvings > 0 && may_hide(a, b, std::abs(middle.f - middle_of_cubic(a, b)))) {
      hard_cell(a, middle, halvings - 1);
      hard_cell(middle, b, halvings - 1);
      return;
    }
    plain_cell(a, b);
  }

  /// Where the ends show all.
  void plain_cell(const GraphPoint& a, const GraphPoint& b) noexcept {
    if (differ(a.f, b.f)) {
      add({root(a, b), 0});
    } else if (differ(a.f, a.slope) && differ(a.slope, b.slope)) {
      valley(a, b);
    }
  }

  [[nodiscard]] int count() const noexcept { return count_; }

 private:
  GraphPoint point(double x) const noexcept {
    const TrigSeries::Values v = series_.at(x);
    return {x, v.f, v.slope};
  }

  void add(const TrigSeries::Root& root) noexcept {
    if (count_ < TrigSeries::kMaxRoots) out_[count_++] = root;
  }

  /// |f| has one minimum between `a` and `b`, where f has one sign.
  void valley(const GraphPoint& a, const GraphPoint& b) noexcept {
    const double x = extremum(a, b);
    const TrigSeries::Values v = series_.at(x);
    if (std::abs(v.f) <= least_) {
      const double spread = std::sqrt(2 * (least_ + std::abs(v.f)) / std::abs(v.bend));
      add({x, std::min(spread, b.x - a.x)});
    } else if (differ(v.f, a.f)) {
      const GraphPoint floor{x, v.f, v.slope};
      add({root(a, floor), 0});
      add({root(floor, b), 0});
    }
  }

  double root(const GraphPoint& a, const GraphPoint& b) const noexcept {
    return zero<&TrigSeries::Values::f, &TrigSeries::Values::slope>({a.x, a.f}, {b.x, b.f});
  }
  double extremum(const GraphPoint& a, const GraphPoint& b) const noexcept {
    return zero<&TrigSeries::Values::slope, &TrigSeries::Values::bend>({a.x, a.slope},
                                                                       {b.x, b.slope});
  }
  struct End {
    double x, value;
  };
  /// Where `kValue`, whose derivative is `kRate`, is zero between ends at which its signs differ:
  /// by Newton's steps, halves where they lead out.
  template <auto kValue, auto kRate>
  double zero(const End& a, const End& b) const noexcept {
    double low = a.x, high = b.x;
    double x = low - a.value * (high - low) / (b.value - a.value);
    for (int i = 0; i < kMostSteps; ++i) {
      const TrigSeries::Values v = series_.at(x);
      (differ(v.*kValue, a.value) ? high : low) = x;
      const double next = inside(x - v.*kValue / (v.*kRate), low, high);
      if (std::abs(next - x) < kSameRoot) return next;
      x = next;
    }
    return x;
  }
  /// `x`, or the middle where that is not between the two.
  static double inside(double x, double low, double high) noexcept {
    return x > low && x < high ? x : 0.5 * (low + high);
  }

  const TrigSeries& series_;
  const double least_;
  TrigSeries::Root* out_;
  int count_ = 0;
};

}  // namespace

double TrigSeries::sample(int j) noexcept {
  return kFirstSample + j * (2 * std::numbers::pi / kSamples);
}

TrigSeries::TrigSeries(const double* f) noexcept {
  const TrigTables& tables = trig_tables();
  double sums[kTerms] = {};
  for (int j = 0; j < kSamples; ++j) {
    for (int t = 0; t < kTerms; ++t) sums[t] += f[j] * tables.samples[j][t];
  }
  cosine[0] = sums[0] / kSamples;
  for (int k = 1; k <= kDegree; ++k) {
    cosine[k] = sums[k] * (2.0 / kSamples);
    sine[k] = sums[kDegree + k] * (2.0 / kSamples);
  }
  double off = 0;
  for (int j = 0; j < kSamples; ++j) {
    double value = cosine[0];
    for (int k = 1; k <= kDegree; ++k) {
      value += cosine[k] * tables.samples[j][k] + sine[k] * tables.samples[j][kDegree + k];
    }
    largest = std::max(largest, std::abs(f[j]));
    off = std::max(off, std::abs(f[j] - value));
  }
  noise = off / largest;
}

TrigSeries::Values TrigSeries::at(double x) const noexcept {
  double s1 = 0, c1 = 0;
  sin_cos_inside(x, s1, c1);
  Values out{cosine[0], 0, 0};
  double s = 0, c = 1;
  for (int k = 1; k <= kDegree; ++k) {
    const double next = c * c1 - s * s1;
    s = s * c1 + c * s1;
    c = next;
    const double value = cosine[k] * c + sine[k] * s;
    out.f += value;
    out.slope += k * (sine[k] * c - cosine[k] * s);
    out.bend -= k * k * value;
  }
  return out;
}

int TrigSeries::roots(double touch, Root* out) const noexcept {
  const TrigTables& tables = trig_tables();
  double f[kGrid], slope[kGrid], miss[kGrid];
  for (int j = 0; j < kGrid; ++j) {
    f[j] = cosine[0];
    slope[j] = 0;
  }
  for (int k = 1; k <= kDegree; ++k) {
    for (int j = 0; j < kGrid; ++j) {
      const double c = tables.grid[k][j], s = tables.grid[kDegree + k][j];
      f[j] += cosine[k] * c + sine[k] * s;
      slope[j] += k * (sine[k] * c - cosine[k] * s);
    }
  }
  const auto point = [&](int j) {
    return GraphPoint{kGridStep * j, f[j % kGrid], slope[j % kGrid]};
  };
  for (int j = 0; j < kGrid; ++j) {
    GraphPoint before = point(j + kGrid - 1);
    before.x = kGridStep * (j - 1);
    // What a cubic over two cells misses is 16 times that over one.
    miss[j] = std::abs(f[j] - middle_of_cubic(before, point(j + 1))) / 16;
  }
  RootScan scan(*this, touch * largest, out);
  for (int j = 0; j < kGrid; ++j) {
    const GraphPoint a = point(j), b = point(j + 1);
    if (may_hide(a, b, std::max(miss[j], miss[(j + 1) % kGrid]))) {
      scan.hard_cell(a, b, kHalvings);
    } else {
      scan.plain_cell(a, b);
    }
  }
  return scan.count();
}

}  // namespace mjarm::detail
