#include "mjarm/kinematics/general_six.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mjarm/core/units.hpp"
#include "mjarm/kinematics/branches_internal.hpp"
#include "mjarm/kinematics/general_six_internal.hpp"
#include "mjarm/kinematics/trig_internal.hpp"

namespace mjarm {
namespace detail {
namespace {

constexpr double kTouch = 1e-12;      // of the largest determinant: least rounding
constexpr double kNoises = 10;        // noise of the series by which an extremum may miss 0
constexpr double kLowNoise = 1e-12;   // with less, one order of the columns is enough
constexpr double kClosePair = 0.003;  // [rad] roots so near to each other are taken as a pair, too
constexpr double kMet = 1e-8;      // error of what Newton's steps, still under way, will make exact
constexpr double kSameRow = 1e-6;  // [rad] of all joints: found twice

using Roots = TrigSeries::Root[TrigSeries::kMaxRoots];

/// True where roots that may be two lie so close that there may be more than four.
bool is_crowded(const Roots& roots, int count) noexcept {
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < i; ++k) {
      const double reach = roots[i].spread + roots[k].spread;
      if (roots[i].spread == 0 || roots[k].spread == 0) continue;
      if (std::abs(roots[i].x - roots[k].x) <= reach) return true;
    }
  }
  return false;
}

/// The roots of a series; between two that are close, one more that stands for both.
struct RootsAndPairs {
  Roots roots;
  int count = 0;
  bool crowded = false;

  explicit RootsAndPairs(const TrigSeries& series) noexcept {
    const int found = series.roots(std::max(kTouch, kNoises * series.noise), roots);
    crowded = is_crowded(roots, found);
    count = found;
    for (int i = 0; i < found && count < TrigSeries::kMaxRoots; ++i) {
      const int next = (i + 1) % found;
      const double gap = roots[next].x - roots[i].x + (next == 0 ? kFullTurn : 0);
      if (gap < kClosePair) roots[count++] = {roots[i].x + 0.5 * gap, 0.5 * gap};
    }
  }
};

bool same_row(const double* a, const double* b) noexcept {
  bool same = true;
  for (int k = 0; k < 6; ++k) {
    const double d = a[k] - b[k];
    same = same && std::abs(d - kFullTurn * nearest_whole(d * (1 / kFullTurn))) < kSameRow;
  }
  return same;
}

/// Takes values of joint 4, a block at a time, to configurations.
class BranchBlocks {
 public:
  BranchBlocks(const GeneralGeometry& g, bool reversed, const Pose& X_WT, Branches& out) noexcept
      : g_(g), reversed_(reversed), X_WT_(X_WT), out_(out) {
    set_equations(g_, g_.rows.front(), X_WT_, equations_);
  }

  void run() noexcept {
    const RootsAndPairs all(determinant_series(g_, equations_, X_WT_));
    for (int i = 0; i < all.count; ++i) {
      if (all.roots[i].spread == 0) add(all.roots[i].x, false);
    }
    flush(false);
    for (int i = 0; i < all.count; ++i) {
      const TrigSeries::Root& root = all.roots[i];
      if (root.spread == 0) continue;
      for (const double side : {-1.0, -0.3, 0.3, 1.0}) {
        add(root.x + side * root.spread, true);
        add(root.x + side * root.spread, true);
      }
    }
    flush(true);
    out_.complete = !all.crowded;
  }

 private:
  void add(double q4, bool pairs) noexcept {
    q4_[filled_++] = q4;
    if (filled_ == kBlock) flush(pairs);
  }

  void flush(bool pairs) noexcept {
    if (filled_ == 0) return;
    for (int k = filled_; k < kBlock; ++k) q4_[k] = q4_[0];
    GeneralBlock block;
    general_kernel().configurations(g_, equations_, X_WT_, q4_, pairs, block);
    for (int k = 0; k < filled_; ++k) {
      if (block.error[k] < kMet) take(block, k);
    }
    filled_ = 0;
  }

  void take(const GeneralBlock& block, int lane) noexcept {
    double row[6];
    for (int i = 0; i < 6; ++i) {
      const double q = arc_tangent(block.sine[i][lane], block.cosine[i][lane]);
      row[reversed_ ? 5 - i : i] = reversed_ ? -q : q;
    }
    for (int i = 0; i < out_.count; ++i) {
      if (same_row(row, out_.q[i])) return;
    }
    if (double* const to = out_.add()) std::copy_n(row, 6, to);
  }

  const GeneralGeometry& g_;
  const bool reversed_;
  const Pose X_WT_;
  Branches& out_;
  GeneralEquations equations_;
  double q4_[kBlock];
  int filled_ = 0;
};

}  // namespace

void set_equations(const GeneralGeometry& g, const GeneralRows& rows, const Pose& X_WT,
                   GeneralEquations& out) noexcept {
  // Axis 1 seen from the frame of joint 6 after its motion.
  const Pose X = g.chain.X_JT * X_WT.inverse() * g.chain.X_PJ[0];
  const Eigen::Vector3d p = X.p / g.length;
  const Eigen::Vector3d h = X.R.col(2);
  const Eigen::Vector3d m = p.cross(h);
  const Eigen::Vector3d w = p.squaredNorm() * h - 2 * p.dot(h) * p;
  const double flag[GeneralRows::kFlag] = {h.x(), h.y(), h.z(), m.x(),           m.y(),
                                           m.z(), w.x(), w.y(), w.z(),           p.dot(h),
                                           p.x(), p.y(), p.z(), p.squaredNorm(), 1};
  general_kernel().equations(rows, flag, out);
}

TrigSeries determinant_series(const GeneralGeometry& g, const GeneralEquations& equations,
                              const Pose& X_WT) noexcept {
  GeneralEquations change;
  if (g.lacking > 0) set_equations(g, g.rows.back(), X_WT, change);
  TrigSeries out;
  for (int order = 0; order < (g.lacking > 0 ? 2 : 1); ++order) {
    double f[TrigSeries::kSamples];
    for (int at = 0; at < TrigSeries::kSamples; at += kBlock) {
      double q4[kBlock];
      for (int k = 0; k < kBlock; ++k) q4[k] = TrigSeries::sample(at + k);
      general_kernel().determinants(g, equations, change, order, q4, f + at);
    }
    const TrigSeries series(f);
    if (order == 0 || series.noise < out.noise) out = series;
    if (out.noise < kLowNoise) break;
  }
  return out;
}

}  // namespace detail

void GeneralSix::branches(const detail::BranchQuery& query, detail::Branches& out) const noexcept {
  const Pose X_WT = reversed_ ? query.X_WT.inverse() : query.X_WT;
  detail::BranchBlocks(geometry_, reversed_, X_WT, out).run();
}

}  // namespace mjarm
