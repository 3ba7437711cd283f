#include "mjarm/trajectory/path_timing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "mjarm/core/messages/trajectory.hpp"
#include "mjarm/trajectory/limits_internal.hpp"
#include "mjarm/trajectory/path_torque_internal.hpp"
#include "mjarm/trajectory/peaks_internal.hpp"
#include "mjarm/trajectory/smooth_timing_internal.hpp"
#include "mjarm/trajectory/speed_profile_internal.hpp"
#include "mjarm/trajectory/spline_internal.hpp"

namespace mjarm {
namespace {

using detail::Bounds;
using detail::CubicSpline;

constexpr detail::PathBounds kFree{1e100, 1e100, std::numeric_limits<double>::infinity()};

/// Waypoints with the chord length up to each, those left out that repeat the
/// one before.
Result<JointPath> along_chords(std::span<const JointVec> waypoints) {
  constexpr double kSame = 1e-9;  // of the whole length
  const Eigen::Index dof = waypoints.empty() ? 0 : waypoints[0].size();
  double length = 0;
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const JointVec& q = waypoints[i];
    if (dof == 0 || q.size() != dof || !q.allFinite()) {
      return fail(Errc::bad_input, text(msg::trajectory_bad_waypoint, i));
    }
    if (i > 0) length += (q - waypoints[i - 1]).norm();
    if (!std::isfinite(length)) {
      return fail(Errc::bad_input, text(msg::trajectory_bad_waypoint, i));
    }
  }
  if (waypoints.empty()) return fail(Errc::bad_input, text(msg::trajectory_bad_waypoint, 0));
  JointPath path{{0.0}, {waypoints[0]}};
  for (const JointVec& q : waypoints.subspan(1)) {
    const double step = (q - path.q.back()).norm();
    if (step > kSame * length) {
      path.s.push_back(path.s.back() + step);
      path.q.push_back(q);
    }
  }
  if (path.q.size() > 1) path.q.back() = waypoints.back();
  return path;
}

/// The fastest motion where accelerations may jump.
Result<Trajectory> time_with_jumps(const CubicSpline& spline, const Bounds& bounds) {
  constexpr std::size_t kCells = 800;
  const Result<detail::SpeedProfile> fastest =
      detail::fastest_profile(spline, kCells, bounds, kFree);
  if (!fastest) return fail(fastest.error());
  const detail::SpeedProfile& profile = *fastest;
  std::size_t piece = 0;
  const auto knot = [&](std::size_t i) {
    while (piece + 2 < spline.knots().size() && spline.knots()[piece + 1] <= profile.s[i]) ++piece;
    const detail::SplinePoint p = spline.at(profile.s[i], piece);
    const double v = profile.v[i], a_before = i > 0 ? profile.a_before[i] : profile.a_after[i];
    return Trajectory::Knot{{p.q, v * p.d, a_before * p.d + v * v * p.e},
                            profile.a_after[i] * p.d + v * v * p.e};
  };
  Result<Trajectory> motion = Trajectory::from_knots(profile.t, knot);
  if (!motion) return motion;
  const double factor = detail::peaks_of(*motion, bounds, false).stretch(bounds);
  return std::move(*motion).stretched(factor);
}

/// Limits with those of torques, where these matter.
Result<Bounds> bounds_of(const JointLimits& limits, const PathTimingOptions& options,
                         Eigen::Index dof) {
  Result<Bounds> bounds = detail::bounds_of(limits, {}, dof);
  if (!bounds || !options.dynamics) return bounds;
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  if (!positive(options.torque_share) || options.torque_share > 1) {
    return fail(Errc::bad_input, text(msg::trajectory_bad_share, options.torque_share));
  }
  if (limits.torque.size() != dof ||
      !std::all_of(limits.torque.begin(), limits.torque.end(), positive)) {
    return fail(Errc::bad_input, text(msg::trajectory_bad_torques, dof));
  }
  bounds->torque = options.torque_share * limits.torque;
  bounds->dynamics = options.dynamics;
  return bounds;
}

/// A rest of no duration, where the arm can be held there.
Result<Trajectory> rest_at(const JointVec& q, const Bounds& bounds) {
  const JointState rest = JointState::at_rest(q);
  if (bounds.dynamics) {
    const Result<void> held =
        detail::check_still(bounds.dynamics(q, rest.v, rest.a), bounds.torque, 0);
    if (!held) return fail(held.error());
  }
  return Trajectory::through({0.0}, {rest});
}

}  // namespace

Result<Trajectory> time_waypoint_path(std::span<const JointVec> waypoints,
                                      const JointLimits& limits, const PathTimingOptions& options) {
  const Result<JointPath> path = along_chords(waypoints);
  if (!path) return fail(path.error());
  const Result<Bounds> bounds = bounds_of(limits, options, path->q[0].size());
  if (!bounds) return fail(bounds.error());
  if (path->q.size() == 1) return rest_at(path->q[0], *bounds);

  const CubicSpline spline(path->s, path->q, detail::SplineEnds::natural);
  Result<Trajectory> motion = options.jerk_limits ? detail::time_smoothly(spline, *bounds, kFree)
                                                  : time_with_jumps(spline, *bounds);
  if (!motion || !bounds->dynamics) return motion;
  const Result<double> factor = detail::stretch_for_torque(*motion, *bounds);
  if (!factor) return fail(factor.error());
  return std::move(*motion).stretched(*factor);
}

}  // namespace mjarm
