#include "mjarm/path/solve_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "mjarm/core/finite.hpp"
#include "mjarm/path/even_track_internal.hpp"
#include "mjarm/path/path_cause_internal.hpp"
#include "mjarm/path/track_search_internal.hpp"

namespace mjarm {
namespace {

constexpr double kMaxTilt = std::numbers::pi / 2;  // [rad]

bool is_sound(const IkSolver& ik, std::span<const Pose> poses, std::span<const double> s,
              std::span<const double> q_start, const PathOptions& options) {
  return !poses.empty() && poses.size() == s.size() && all_finite(s) &&
         std::is_sorted(s.begin(), s.end()) && all_finite(q_start) &&
         q_start.size() == ik.arm().joints.size() && is_sound_step(options.max_step) &&
         options.orientation_tol >= 0 && options.orientation_tol < kMaxTilt &&
         options.comfort >= 0 && options.comfort <= 1 && options.tool_speed >= 0 &&
         std::isfinite(options.tool_speed);
}

/// The track found, evened out where it moves aside or tilts the tool.
detail::Track even_track(const detail::PathLayers& layers, std::span<const Pose> poses,
                         std::span<const double> s, const JointVec& q_from) {
  detail::Track track = detail::find_track(layers, poses, q_from);
  const bool whole = track.size() == poses.size();
  if (whole && (track.last.front().aside || layers.options().orientation_tol > 0)) {
    detail::even_out(layers, poses, s, track);
  }
  return track;
}

/// The track without any tilt, where it has room enough: none is better then.
std::optional<JointPath> upright(const IkSolver& ik, std::span<const Pose> poses,
                                 std::span<const double> s, const JointVec& q_from,
                                 PathOptions options) {
  options.orientation_tol = 0;
  const detail::PathLayers layers(ik, options);
  detail::Track track = even_track(layers, poses, s, q_from);
  if (track.size() < poses.size() || track.last.front().rank.tightness > options.comfort) {
    return std::nullopt;
  }
  return JointPath{{s.begin(), s.end()}, std::move(track.q)};
}

}  // namespace

Result<JointPath, PathFailure> solve_path(const IkSolver& ik, std::span<const Pose> poses,
                                          std::span<const double> s,
                                          std::span<const double> q_start,
                                          const PathOptions& options) {
  if (!is_sound(ik, poses, s, q_start, options)) {
    PathFailure failure;
    failure.code = PathErrc::bad_input;
    failure.ik.code = IkErrc::bad_input;
    return fail(std::move(failure));
  }
  const JointVec q_from = clamp_to_limits(ik.arm(), q_start);
  if (options.orientation_tol > 0) {
    if (auto path = upright(ik, poses, s, q_from, options)) return std::move(*path);
  }
  const detail::PathLayers layers(ik, options);
  detail::Track track = even_track(layers, poses, s, q_from);
  const auto known = s.first(track.size());
  JointPath path{{known.begin(), known.end()}, std::move(track.q)};
  if (path.q.size() == poses.size()) return path;
  track.q = path.q;
  PathFailure failure;
  if (!track.is_stopped) failure = detail::find_cause(layers, poses, track, q_from);
  if (is_stopped(options.stop)) {
    failure = {};
    failure.code = PathErrc::stopped;
    failure.at = path.q.size();
    failure.fraction = static_cast<double>(failure.at) / static_cast<double>(poses.size());
  }
  if (!path.s.empty()) failure.s = path.s.back();
  failure.partial = std::move(path);
  return fail(std::move(failure));
}

Result<JointPath, PathFailure> solve_path(const IkSolver& ik, std::span<const Pose> poses,
                                          std::span<const double> q_start,
                                          const PathOptions& options) {
  std::vector<double> s(poses.size());
  std::iota(s.begin(), s.end(), 0.0);
  return solve_path(ik, poses, s, q_start, options);
}

std::vector<UnreachableRange> unreachable_ranges(const IkSolver& ik, std::span<const Pose> poses,
                                                 std::span<const double> q_seed,
                                                 const StopCheck& stop) {
  std::vector<UnreachableRange> ranges;
  JointVec seed = joint_vec(q_seed.first(std::min<std::size_t>(q_seed.size(), kMaxDof)));
  for (std::size_t i = 0; i < poses.size() && !is_stopped(stop); ++i) {
    const auto answer = ik.solve(poses[i], as_span(seed));
    if (answer) {
      seed = answer->q;
    } else if (!ranges.empty() && ranges.back().last + 1 == i) {
      ranges.back().last = i;
      if (answer.error().amount > ranges.back().worst.amount) ranges.back().worst = answer.error();
    } else {
      ranges.push_back({i, i, answer.error()});
    }
  }
  return ranges;
}

}  // namespace mjarm
