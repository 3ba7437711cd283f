#include "mjarm/trajectory/path_timing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "mjarm/core/messages/trajectory.hpp"
#include "mjarm/trajectory/limits_internal.hpp"
#include "mjarm/trajectory/peaks_internal.hpp"
#include "mjarm/trajectory/smooth_timing_internal.hpp"
#include "mjarm/trajectory/speed_profile_internal.hpp"
#include "mjarm/trajectory/spline_internal.hpp"

namespace mjarm {
namespace {

using detail::Bounds;
using detail::CubicSpline;

constexpr detail::PathBounds kFree{1e100, 1e100, std::numeric_limits<double>::infinity()};

/// Waypoints with the chord length up to each, those left out that repeat the one before.
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
  const detail::SpeedProfile profile = detail::fastest_profile(spline, kCells, bounds, kFree);
  std::vector<JointState> knots;
  std::vector<JointVec> a_after;
  knots.reserve(profile.s.size());
  a_after.reserve(profile.s.size());
  std::size_t piece = 0;
  for (std::size_t i = 0; i < profile.s.size(); ++i) {
    while (piece + 2 < spline.knots().size() && spline.knots()[piece + 1] <= profile.s[i]) ++piece;
    const detail::SplinePoint p = spline.at(profile.s[i], piece);
    const double v = profile.v[i];
    knots.push_back({p.q, v * p.d, profile.a_before[i] * p.d + v * v * p.e});
    a_after.push_back(profile.a_after[i] * p.d + v * v * p.e);
  }
  knots.front().a = a_after.front();
  return Trajectory::through(profile.t, knots, a_after);
}

}  // namespace

Result<Trajectory> time_waypoint_path(std::span<const JointVec> waypoints,
                                      const JointLimits& limits, const PathTimingOptions& options) {
  const Result<JointPath> path = along_chords(waypoints);
  if (!path) return fail(path.error());
  const Result<Bounds> bounds = detail::bounds_of(limits, {}, path->q[0].size());
  if (!bounds) return fail(bounds.error());
  const JointVec zero = JointVec::Zero(path->q[0].size());
  if (path->q.size() == 1) return Trajectory::through({0.0}, {{path->q[0], zero, zero}});

  const CubicSpline spline(path->s, path->q, detail::SplineEnds::natural);
  if (options.jerk_limits) return detail::time_smoothly(spline, *bounds, kFree);
  const Result<Trajectory> fastest = time_with_jumps(spline, *bounds);
  if (!fastest) return fail(fastest.error());
  return fastest->stretched(detail::peaks_of(*fastest, *bounds).stretch(false));
}

}  // namespace mjarm
