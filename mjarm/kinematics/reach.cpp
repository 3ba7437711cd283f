#include "mjarm/kinematics/reach.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "mjarm/kinematics/axis_chain_internal.hpp"

namespace mjarm {
namespace {

constexpr double kRounding = 1e-9;  // [m] all bounds are widened by this

/// The distance range between neighbours of `points` (pieces), and across two pieces through the
/// joint between them (pairs, entry k: from point k - 1 to point k + 1).
struct Pieces {
  std::vector<DistanceRange> single;
  std::vector<DistanceRange> pair;
};

Pieces measure(const AxisChain& chain, const std::vector<Eigen::Vector3d>& points) {
  const std::size_t n = points.size();
  Pieces out;
  out.pair.resize(n);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double length = (points[i + 1] - points[i]).norm();
    const double slack = chain.axes[i + 1].slack_before;
    out.single.push_back({std::max(length - slack, 0.0), length + slack});
  }
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const HingeAxis& axis = chain.axes[k];
    const double slack = axis.slack_before + chain.axes[k + 1].slack_before;
    const DistanceRange range = distance_across(
        points[k - 1] - points[k], points[k + 1] - points[k], axis.a_W, axis.lower, axis.upper);
    out.pair[k] = {std::max(range.low - slack, 0.0), range.high + slack};
  }
  return out;
}

/// Smallest provable greatest distance from the first point to each point, walking `pieces`
/// forwards.
std::vector<double> stretch(const Pieces& pieces, bool backwards) {
  const std::size_t n = pieces.pair.size();
  std::vector<double> best(n, 0.0);
  for (std::size_t i = 1; i < n; ++i) {
    const std::size_t piece = backwards ? n - 1 - i : i - 1;
    const std::size_t joint = backwards ? n - i : i - 1;
    best[i] = best[i - 1] + pieces.single[piece].high;
    if (i >= 2) best[i] = std::min(best[i], best[i - 2] + pieces.pair[joint].high);
  }
  return best;
}

/// Greatest provable smallest distance between the ends: one piece or pair against all the others.
double fold(const Pieces& pieces) {
  const std::size_t n = pieces.pair.size();
  const std::vector<double> before = stretch(pieces, false);
  const std::vector<double> after = stretch(pieces, true);
  double best = 0;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    best = std::max(best, pieces.single[i].low - before[i] - after[n - 2 - i]);
  }
  for (std::size_t k = 1; k + 1 < n; ++k) {
    best = std::max(best, pieces.pair[k].low - before[k - 1] - after[n - 2 - k]);
  }
  return best;
}

double length_of(const std::vector<Eigen::Vector3d>& points) {
  double length = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) length += (points[i + 1] - points[i]).norm();
  return length;
}

}  // namespace

Reach::Reach(const Arm& arm) : outer_(std::numeric_limits<double>::infinity()) {
  if (arm.dof() < 1 || arm.dof() > kMaxDof) return;
  const AxisChain chain(arm);
  if (!std::isfinite(chain.slack)) return;
  const int n = static_cast<int>(chain.axes.size());
  if (n == 0) {
    p_WA_ = chain.X_WT.p;
    outer_ = chain.slack + kRounding;
    return;
  }
  const std::vector<Eigen::Vector3d> points = shortest_polyline(chain, 0, n - 1);
  const Pieces pieces = measure(chain, points);
  const double ends = chain.axes.front().slack_before + chain.slack_after;
  p_WA_ = points.front();
  p_TB_ = chain.X_WT.inverse() * points.back();
  outer_ = stretch(pieces, false).back() + ends + kRounding;
  inner_ = std::max(fold(pieces) - ends - kRounding, 0.0);
  set_cylinder(chain);
}

void Reach::set_cylinder(const AxisChain& chain) {
  const int n = static_cast<int>(chain.axes.size());
  if (n < 2 || chain.slack > 0) return;
  const HingeAxis& base = chain.axes[0];
  const Eigen::Vector3d& side = chain.axes[1].a_W;
  constexpr double kParallel = 1e-4;  // [rad] rounded figures of a file still count as parallel
  double skew = std::abs(side.dot(base.a_W));
  if (skew > kParallel) return;
  int last = 1;  // last axis of the group that is parallel to `side`
  while (last + 1 < n &&
         chain.axes[static_cast<std::size_t>(last + 1)].a_W.cross(side).norm() <= kParallel) {
    ++last;
    skew += chain.axes[static_cast<std::size_t>(last)].a_W.cross(side).norm();
  }
  std::vector<Eigen::Vector3d> tail{chain.X_WT.p};
  if (last + 1 < n) tail = shortest_polyline(chain, last + 1, n - 1);
  // While the group turns, its point moves only across `side`, so its offset along it stays; what
  // misaligned axes can shift it by is taken off twice over.
  const double arm_length = length_of(shortest_polyline(chain, 0, last)) +
                            (tail.front() - chain.axes[static_cast<std::size_t>(last)].p_W).norm();
  const double offset = std::abs(side.dot(tail.front() - base.p_W));
  const double radius = offset - length_of(tail) - 2 * skew * (arm_length + offset) - kRounding;
  if (radius <= 0) return;
  cylinder_ = radius;
  axis_W_ = base.a_W;
  p_WC_ = base.p_W;
  p_TC_ = chain.X_WT.inverse() * tail.back();
}

std::optional<ReachBreach> Reach::check(const Pose& X_WT) const noexcept {
  return check_points(X_WT * p_TB_, 0, X_WT * p_TC_, 0);
}

std::optional<ReachBreach> Reach::check_position(const Eigen::Vector3d& p_WT) const noexcept {
  return check_points(p_WT, p_TB_.norm(), p_WT, p_TC_.norm());
}

std::optional<ReachBreach> Reach::check_points(const Eigen::Vector3d& p_WB, double slack_B,
                                               const Eigen::Vector3d& p_WC,
                                               double slack_C) const noexcept {
  double distance = (p_WB - p_WA_).norm();
  if (!std::isfinite(distance)) {  // a square of it is not
    distance = std::min((p_WB - p_WA_).stableNorm(), std::numeric_limits<double>::max());
  }
  const double outer = outer_ + slack_B;
  if (distance > outer) return ReachBreach{ReachShape::outer_sphere, distance - outer, outer};
  const double from_axis = (p_WC - p_WC_).cross(axis_W_).norm();
  ReachBreach inner{ReachShape::inner_sphere, inner_ - slack_B - distance, inner_ - slack_B};
  const ReachBreach round{ReachShape::cylinder, cylinder_ - slack_C - from_axis,
                          cylinder_ - slack_C};
  if (round.amount > inner.amount) inner = round;
  if (inner.amount > 0) return inner;
  return std::nullopt;
}

}  // namespace mjarm
