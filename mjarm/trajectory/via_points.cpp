#include "mjarm/trajectory/via_points.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "mjarm/core/messages/trajectory.hpp"
#include "mjarm/trajectory/kept_limits_internal.hpp"
#include "mjarm/trajectory/limits_internal.hpp"
#include "mjarm/trajectory/point_to_point.hpp"
#include "mjarm/trajectory/via_points_solver_internal.hpp"

namespace mjarm {
namespace {

constexpr double kSame = 1e-10;    // [rad or m] neighbours nearer than this are one waypoint
constexpr double kMissed = 1e-9;   // [rad or m] a motion that passes farther off is not used
constexpr std::size_t kLeg = 512;  // most steps between rests, so that memory stays bounded

/// The waypoints without repetitions, and which of them stands for each one given.
struct Distinct {
  std::vector<JointVec> points;
  std::vector<std::size_t> stands_for;
};

Distinct without_repetitions(std::span<const JointVec> waypoints) {
  Distinct distinct;
  for (const JointVec& q : waypoints) {
    if (distinct.points.empty() || (q - distinct.points.back()).cwiseAbs().maxCoeff() > kSame) {
      distinct.points.push_back(q);
    }
    distinct.stands_for.push_back(distinct.points.size() - 1);
  }
  return distinct;
}

JointLimits limits_of(const detail::Bounds& bounds) {
  JointLimits limits;
  limits.velocity = bounds.v;
  limits.acceleration = bounds.a;
  limits.jerk = bounds.j;
  return limits;
}

Result<ViaMotion> stopping_at_each(std::span<const JointVec> points, const detail::Bounds& bounds) {
  const JointLimits limits = limits_of(bounds);
  std::vector<Trajectory> moves;
  ViaMotion motion{{}, {0}};
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    Result<Trajectory> move =
        point_to_point(JointState::at_rest(points[i]), JointState::at_rest(points[i + 1]), limits);
    if (!move) return fail(std::move(move.error()));
    motion.times.push_back(motion.times.back() + move->duration());
    moves.push_back(*std::move(move));
  }
  Result<Trajectory> chained = Trajectory::chain(moves);
  if (!chained) return fail(std::move(chained.error()));
  motion.trajectory = *std::move(chained);
  return motion;
}

/// Each segment starts at its waypoint anew, so that rounding does not add up on the way.
Result<Trajectory> trajectory_of(const detail::ViaSpline& spline,
                                 std::span<const JointVec> points) {
  const auto state = [&](int k) {
    return JointState{points[static_cast<std::size_t>(k)], spline.v.col(k), spline.a.col(k)};
  };
  std::vector<Trajectory> segments;
  for (int k = 0; k < spline.segments(); ++k) {
    const double h = spline.h[static_cast<std::size_t>(k)];
    std::vector<JointVec> jerks(detail::kCells, JointVec(spline.joints()));
    for (int j = 0; j < spline.joints(); ++j) {
      const detail::Coefs c = detail::coefs_of(spline, k, j);
      for (std::size_t i = 0; i < jerks.size(); ++i) {
        jerks[i][j] = (c[i + 2] - 2 * c[i + 1] + c[i]) / (h * h);
      }
    }
    Result<Trajectory> segment =
        Trajectory::from_jerks(state(k), std::vector<double>(jerks.size(), h), jerks, state(k + 1));
    if (!segment) return segment;
    segments.push_back(*std::move(segment));
  }
  return Trajectory::chain(segments);
}

/// None where the optimiser fails, or rounding makes the motion miss a waypoint or break a limit.
std::optional<ViaMotion> optimised(std::span<const JointVec> points, const detail::Bounds& bounds,
                                   int iterations) {
  std::vector<JointVec> steps;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) steps.push_back(points[i + 1] - points[i]);
  const std::optional<detail::ViaSpline> spline = detail::fastest_via(steps, bounds, iterations);
  if (!spline) return std::nullopt;
  Result<Trajectory> trajectory = trajectory_of(*spline, points);
  if (!trajectory || !detail::check_kept(*trajectory, limits_of(bounds), true)) return std::nullopt;
  ViaMotion motion{*std::move(trajectory), {0}};
  for (const double h : spline->h) motion.times.push_back(motion.times.back() + detail::kCells * h);
  motion.times.back() = motion.trajectory.duration();
  for (std::size_t i = 0; i < points.size(); ++i) {
    // The end is asked for just before it, where the phases lead and not the state held there.
    const double t = i + 1 < points.size() ? motion.times[i] : std::nextafter(motion.times[i], 0.0);
    const JointVec off = motion.trajectory.at(t).q - points[i];
    if (!(off.cwiseAbs().maxCoeff() <= kMissed)) return std::nullopt;
  }
  return motion;
}

Result<detail::Bounds> check(std::span<const JointVec> waypoints, const JointLimits& limits,
                             const ViaOptions& options) {
  const Eigen::Index dof = waypoints.empty() ? 0 : waypoints[0].size();
  for (std::size_t i = 0; i < std::max<std::size_t>(waypoints.size(), 1); ++i) {
    if (dof == 0 || waypoints[i].size() != dof || !waypoints[i].allFinite()) {
      return fail(Errc::bad_input, text(msg::trajectory_bad_waypoint, i));
    }
  }
  if (options.iterations < 0) {
    return fail(Errc::bad_input, text(msg::trajectory_bad_iterations, options.iterations));
  }
  return detail::bounds_of(limits, {.joint_share = options.joint_share}, dof);
}

}  // namespace

Result<ViaMotion> time_via_points(std::span<const JointVec> waypoints, const JointLimits& limits,
                                  const ViaOptions& options) {
  const Result<detail::Bounds> bounds = check(waypoints, limits, options);
  if (!bounds) return fail(bounds.error());
  const Distinct distinct = without_repetitions(waypoints);
  const std::span<const JointVec> points = distinct.points;
  if (points.size() == 1) {
    const JointState rest = JointState::at_rest(points[0]);
    Result<Trajectory> still = Trajectory::from_jerks(rest, {}, {}, rest);
    if (!still) return fail(std::move(still.error()));
    return ViaMotion{*std::move(still), std::vector<double>(waypoints.size(), 0)};
  }
  std::vector<Trajectory> legs;
  std::vector<double> times{0};
  for (std::size_t first = 0; first + 1 < points.size(); first += kLeg) {
    if (is_stopped(options.stop)) return fail(stopped());
    const auto leg = points.subspan(first, std::min(kLeg + 1, points.size() - first));
    Result<ViaMotion> motion = stopping_at_each(leg, *bounds);
    if (!motion) return fail(std::move(motion.error()));
    if (leg.size() > 2) {
      std::optional<ViaMotion> faster = optimised(leg, *bounds, options.iterations);
      if (faster && faster->times.back() < motion->times.back()) motion = *std::move(faster);
    }
    const double start = times.back();
    for (std::size_t i = 1; i < leg.size(); ++i) times.push_back(start + motion->times[i]);
    legs.push_back(std::move(motion->trajectory));
  }
  Result<Trajectory> whole = Trajectory::chain(legs);
  if (!whole) return fail(std::move(whole.error()));
  ViaMotion motion{*std::move(whole), {}};
  for (const std::size_t i : distinct.stands_for) motion.times.push_back(times[i]);
  return motion;
}

}  // namespace mjarm
