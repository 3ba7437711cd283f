#include <algorithm>
#include <cmath>
#include <utility>

#include "mjarm/core/units.hpp"
#include "mjarm/path/fix_search_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kGrid = 0.05;                 // [m]
constexpr std::size_t kPosesSolved = 100'000;  // of all changes of one kind

/// Grid points within `reach`, shortest first; of equal length those along fewer axes first.
std::vector<Eigen::Vector3i> grid_of(double reach) {
  const int n = static_cast<int>(std::floor(reach / kGrid + 1e-9));
  std::vector<Eigen::Vector3i> grid;
  for (int x = -n; x <= n; ++x) {
    for (int y = -n; y <= n; ++y) {
      for (int z = -n; z <= n; ++z) {
        if (x * x + y * y + z * z <= n * n) grid.emplace_back(x, y, z);
      }
    }
  }
  const auto axes = [](const Eigen::Vector3i& g) { return (g.array() != 0).count(); };
  std::stable_sort(grid.begin(), grid.end(), [&](const auto& g, const auto& h) {
    const int length_g = g.squaredNorm(), length_h = h.squaredNorm();
    return length_g != length_h ? length_g < length_h : axes(g) < axes(h);
  });
  return grid;
}

/// To three digits.
double rounded_down(double x) {
  const double unit = std::pow(10, std::floor(std::log10(x)) - 2);
  return unit * std::floor(x / unit);
}

}  // namespace

FixSearch::FixSearch(const IkSolver& ik, std::span<const Pose> poses, std::size_t at,
                     std::span<const double> q_start, const PathOptions& options, Solve solve)
    : ik_(ik),
      poses_(poses),
      at_(std::min(at, poses.size() - 1)),
      q_start_(q_start),
      options_(options),
      solve_(std::move(solve)),
      changed_(poses.size()) {
  const bool fast = ik.six_axis() || ik.seven_axis();
  const auto max = static_cast<int>(std::min<std::size_t>(kPosesSolved / poses.size(), 50));
  max_probed_ = fast ? 500 : 40;
  max_solved_ = std::max(fast ? max : max / 8, 2);
}

/// From cheap to dear: proofs of reach, a few poses spread over the path, the neighbourhood of the
/// place where it stopped, the whole.
bool FixSearch::mends(const PathChange& change) {
  constexpr std::size_t kProofs = 400, kProbes = 8, kAround = 8;
  if (is_stopped(options_.stop)) return false;
  const std::size_t proofs = std::max<std::size_t>(1, poses_.size() / kProofs);
  for (std::size_t i = 0; i < poses_.size(); i += proofs) {
    if (ik_.reach().check(change(poses_[i]))) return false;
  }
  std::transform(poses_.begin(), poses_.end(), changed_.begin(), change);
  if (++probed_ > max_probed_ || solved_ >= max_solved_) return false;
  const std::size_t stride = std::max<std::size_t>(1, changed_.size() / kProbes);
  for (std::size_t i = 0; i < changed_.size(); i += stride) {
    if (!ik_.solve(changed_[i], q_start_)) return false;
  }
  PathOptions any_start = options_;
  any_start.keep_start = false;
  const std::size_t from = at_ - std::min(at_, kAround);
  const auto around =
      std::span(changed_).subspan(from, std::min(2 * kAround, changed_.size() - from));
  if (!solve_path(ik_, around, q_start_, any_start)) return false;
  ++solved_;
  return solve_(change, options_).has_value();
}

std::optional<PathFix> FixSearch::shift(double reach) {
  probed_ = solved_ = 0;
  for (const Eigen::Vector3i& g : grid_of(reach)) {
    const PathFix fix{.kind = FixKind::shift, .change = {.shift = g.cast<double>() * kGrid}};
    if (mends(fix.change)) return fix;
    if (probed_ > max_probed_ || solved_ >= max_solved_) break;
  }
  return std::nullopt;
}

std::optional<PathFix> FixSearch::tilt() {
  probed_ = solved_ = 0;
  for (int degrees = 5; degrees <= 180; degrees += degrees < 60 ? 5 : 15) {
    for (int axis = 2; axis >= (degrees > 60 ? 2 : 0); --axis) {
      for (const int way : {1, -1}) {
        PathFix fix;
        fix.kind = FixKind::tilt;
        fix.change.tilt[axis] = way * degrees * kRadPerDeg;
        if (mends(fix.change)) return fix;
      }
    }
  }
  return std::nullopt;
}

std::optional<PathFix> FixSearch::start() const {
  if (!options_.keep_start) return std::nullopt;
  PathOptions any_start = options_;
  any_start.keep_start = false;
  const auto q = solve_({}, any_start);
  if (!q) return std::nullopt;
  return PathFix{.kind = FixKind::start, .start = *q};
}

std::optional<PathFix> FixSearch::longer_step(const PathFailure& failure) const {
  constexpr double kMax = 1.6;  // [rad] beyond that the tool strays far between the poses
  constexpr double kRound = 0.05;
  if (failure.code != PathErrc::branch_flip && failure.code != PathErrc::singularity) {
    return std::nullopt;
  }
  PathOptions longer = options_;
  longer.max_step = kRound * std::ceil(failure.amount / kRound);
  if (longer.max_step > kMax || longer.max_step <= options_.max_step) return std::nullopt;
  if (!solve_({}, longer)) return std::nullopt;
  return PathFix{.kind = FixKind::max_step, .max_step = longer.max_step};
}

/// The speed at which the joint named just keeps its limit, and lower ones where others do not.
std::optional<PathFix> FixSearch::slower(const PathFailure& failure) const {
  constexpr double kRoom = 0.98, kLess = 0.7;
  constexpr int kTries = 8;
  if (failure.code != PathErrc::joint_speed) return std::nullopt;
  const double limit = ik_.arm().limits.velocity[failure.joint];
  PathOptions options = options_;
  options.tool_speed *= kRoom * limit / (limit + failure.amount);
  for (int k = 0; k < kTries; ++k, options.tool_speed *= kLess) {
    options.tool_speed = rounded_down(options.tool_speed);
    if (solve_({}, options))
      return PathFix{.kind = FixKind::slower, .tool_speed = options.tool_speed};
  }
  return std::nullopt;
}

std::optional<PathFix> FixSearch::find(FixKind kind, const PathFailure& failure) {
  switch (kind) {
    case FixKind::start:
      return start();
    case FixKind::shift:
      return shift(0.6);
    case FixKind::tilt:
      return tilt();
    case FixKind::max_step:
      return longer_step(failure);
    case FixKind::slower:
      return slower(failure);
  }
  return std::nullopt;
}

}  // namespace mjarm::detail
