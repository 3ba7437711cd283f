#include <algorithm>
#include <array>
#include <cmath>

#include "mjarm/core/messages/trajectory.hpp"
#include "mjarm/trajectory/limits_internal.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm {
namespace {

/// Durations [s] of the phases of the fastest move from 0 to 1 from rest to rest: speeding up (jerk
/// +, 0, -), cruise, slowing down (jerk -, 0, +).
struct SevenPhases {
  double jerk_time = 0;
  double accel_time = 0;
  double cruise_time = 0;
};

/// @param v,a,j  limits in units of the whole move. L. Biagiotti and C. Melchiorri, Trajectory
///               Planning for Automatic Machines and Robots (2008), section 3.4 (double S).
SevenPhases seven_phases(double v, double a, double j) {
  SevenPhases phases;
  // To the speed v and back, whether or not the acceleration limit is met on the way.
  phases.jerk_time = std::min(a / j, std::sqrt(v / j));
  phases.accel_time = std::max(0.0, v / a - a / j);
  const double ramp = 2 * phases.jerk_time + phases.accel_time;
  if (v * ramp <= 1) {
    phases.cruise_time = 1 / v - ramp;
    return phases;
  }
  // Too short for that speed: without cruise, with the acceleration limit met or not.
  const double t = a / j;
  if (2 * a * t * t <= 1) {
    phases.jerk_time = t;
    phases.accel_time = 0.5 * (std::sqrt(t * t + 4 / a) - 3 * t);
  } else {
    phases.jerk_time = std::cbrt(0.5 / j);
    phases.accel_time = 0;
  }
  return phases;
}

}  // namespace

Result<Trajectory> time_joint_move(std::span<const double> q0, std::span<const double> q1,
                                   const JointLimits& limits, const TimingOptions& options) {
  if (q0.empty() || q0.size() != q1.size() || q0.size() > static_cast<std::size_t>(kMaxDof)) {
    return fail(Errc::bad_input, text(msg::trajectory_bad_ends));
  }
  const JointVec from = joint_vec(q0), to = joint_vec(q1);
  const JointVec way = to - from, zero = JointVec::Zero(from.size());
  if (!way.allFinite()) return fail(Errc::bad_input, text(msg::trajectory_bad_ends));
  const Result<detail::Bounds> bounds = detail::bounds_of(limits, options, from.size());
  if (!bounds) return fail(bounds.error());
  const JointState start{from, zero, zero}, end{to, zero, zero};
  if (way.isZero(0)) return Trajectory::from_jerks(start, {}, {}, end);

  const JointVec distance = way.cwiseAbs();
  const double v = 1 / distance.cwiseQuotient(bounds->v).maxCoeff();
  const double a = 1 / distance.cwiseQuotient(bounds->a).maxCoeff();
  const double j = 1 / distance.cwiseQuotient(bounds->j).maxCoeff();
  const SevenPhases phases = seven_phases(v, a, j);
  const double tj = phases.jerk_time, ta = phases.accel_time;
  const JointVec jerk = j * way;
  return Trajectory::from_jerks(start, std::array{tj, ta, tj, phases.cruise_time, tj, ta, tj},
                                std::array<JointVec, 7>{jerk, zero, -jerk, zero, -jerk, zero, jerk},
                                end);
}

}  // namespace mjarm
