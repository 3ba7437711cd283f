#include "mjarm/path/path_fix.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mjarm/core/messages/path.hpp"
#include "mjarm/path/fix_search_internal.hpp"

namespace mjarm {
namespace {

std::array<FixKind, 5> order_for(PathErrc cause) {
  using enum FixKind;
  switch (cause) {
    case PathErrc::joint_limit:
    case PathErrc::singularity:
      return {start, tilt, shift, max_step, slower};
    case PathErrc::joint_speed:
      return {slower, tilt, start, shift, max_step};
    default:
      return {start, shift, tilt, max_step, slower};
  }
}

std::vector<PathFix> find_all(detail::FixSearch search, const PathFailure& failure,
                              std::size_t max) {
  std::vector<PathFix> fixes;
  for (const FixKind kind : order_for(failure.code)) {
    if (fixes.size() >= max) break;
    if (auto fix = search.find(kind, failure)) fixes.push_back(std::move(*fix));
  }
  return fixes;
}

/// Solves poses, each changed.
detail::FixSearch::Solve solver(const IkSolver& ik, std::span<const Pose> poses,
                                std::span<const double> q_start) {
  return [&ik, poses, q_start](const PathChange& change,
                               const PathOptions& options) -> std::optional<JointVec> {
    std::vector<Pose> changed(poses.size());
    std::transform(poses.begin(), poses.end(), changed.begin(), change);
    auto path = solve_path(ik, changed, q_start, options);
    if (!path) return std::nullopt;
    return path->q.front();
  };
}

}  // namespace

std::string_view name(FixKind kind) noexcept {
  switch (kind) {
    case FixKind::start:
      return "start";
    case FixKind::shift:
      return "shift";
    case FixKind::tilt:
      return "tilt";
    case FixKind::slower:
      return "slower";
    case FixKind::max_step:
      break;
  }
  return "max_step";
}

std::string describe(const PathFix& fix) {
  switch (fix.kind) {
    case FixKind::start:
      return text(msg::path_fix_start);
    case FixKind::shift: {
      const Eigen::Vector3d& d = fix.change.shift;
      return text(msg::path_fix_shift, d.x(), d.y(), d.z());
    }
    case FixKind::tilt: {
      Eigen::Index axis = 0;
      fix.change.tilt.cwiseAbs().maxCoeff(&axis);
      return text(msg::path_fix_tilt, fix.change.tilt[axis] * 180 / std::numbers::pi,
                  std::string_view("xyz").substr(static_cast<std::size_t>(axis), 1));
    }
    case FixKind::slower:
      return text(msg::path_fix_slower, fix.tool_speed);
    case FixKind::max_step:
      break;
  }
  return text(msg::path_fix_max_step, fix.max_step);
}

std::vector<PathFix> find_fixes(const IkSolver& ik, std::span<const Pose> poses,
                                std::span<const double> q_start, const PathOptions& options,
                                const PathFailure& failure, std::size_t max) {
  if (failure.code == PathErrc::bad_input || poses.empty()) return {};
  return find_all({ik, poses, failure.at, q_start, options, solver(ik, poses, q_start)}, failure,
                  max);
}

std::vector<PathFix> find_fixes(const IkSolver& ik, const Curve& curve,
                                std::span<const double> q_start, const CurveOptions& options,
                                const PathFailure& failure, std::size_t max) {
  if (failure.code == PathErrc::bad_input) return {};
  constexpr double kSamples = 100;
  const std::vector<double> s = curve.stations(std::max(options.step, curve.length() / kSamples),
                                               std::max(options.turn, curve.turn() / kSamples));
  const std::vector<Pose> poses = curve.poses(s);
  const auto at = std::lower_bound(s.begin(), s.end(), failure.s) - s.begin();
  const auto solve_samples = solver(ik, poses, q_start);
  const auto solve = [&](const PathChange& change,
                         const PathOptions& path) -> std::optional<JointVec> {
    // Samples of the curve elsewhere tell most failures in a fraction of the time.
    if (!change.is_none() && !solve_samples(change, path)) return std::nullopt;
    CurveOptions changed = options;
    changed.path = path;
    changed.change = change;
    auto solved = solve_curve(ik, curve, q_start, changed);
    if (!solved) return std::nullopt;
    return solved->q.front();
  };
  return find_all({ik, poses, static_cast<std::size_t>(at), q_start, options.path, solve}, failure,
                  max);
}

Result<Eigen::Vector3d> find_shift(const IkSolver& ik, std::span<const Pose> poses,
                                   std::span<const double> q_seed, const PathOptions& options,
                                   double reach) {
  constexpr double kLongest = 1;  // [m] keeps the grid at 33,000 points
  if (poses.empty() || !(reach >= 0) || !is_sound_step(options.max_step)) {
    return fail(Errc::bad_input, text(msg::path_bad_call));
  }
  detail::FixSearch search(ik, poses, 0, q_seed, options, solver(ik, poses, q_seed));
  const auto fix = search.shift(std::min(reach, kLongest));
  if (!fix) return fail(Errc::impossible, text(msg::path_no_shift, reach));
  return fix->change.shift;
}

}  // namespace mjarm
