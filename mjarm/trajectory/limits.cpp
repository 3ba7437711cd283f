#include <algorithm>
#include <cmath>

#include "mjarm/core/messages/trajectory.hpp"
#include "mjarm/trajectory/limits_internal.hpp"

namespace mjarm {
namespace detail {

Result<Bounds> bounds_of(const JointLimits& limits, const TimingOptions& options,
                         Eigen::Index dof) {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  for (const JointVec* limit : {&limits.velocity, &limits.acceleration, &limits.jerk}) {
    if (limit->size() != dof || !std::all_of(limit->begin(), limit->end(), positive)) {
      return fail(Errc::bad_input, text(msg::trajectory_bad_limits, dof));
    }
  }
  if (!positive(options.joint_share) || options.joint_share > 1) {
    return fail(Errc::bad_input, text(msg::trajectory_bad_share, options.joint_share));
  }
  if (!positive(options.tool_speed)) {
    return fail(Errc::bad_input, text(msg::trajectory_bad_speed, options.tool_speed));
  }
  for (std::size_t i = 0; i < options.tool_speeds.size(); ++i) {
    const SpeedFrom& from = options.tool_speeds[i];
    const bool ascends = i == 0 || from.s >= options.tool_speeds[i - 1].s;
    if (!std::isfinite(from.s) || !ascends || !positive(from.speed)) {
      return fail(Errc::bad_input, text(msg::trajectory_bad_speeds, i));
    }
  }
  if (!positive(options.tool_accel)) {
    return fail(Errc::bad_input, text(msg::trajectory_bad_accel, options.tool_accel));
  }
  if (!positive(options.tool_ramp)) {
    return fail(Errc::bad_input, text(msg::trajectory_bad_ramp, options.tool_ramp));
  }
  return Bounds{options.joint_share * limits.velocity, options.joint_share * limits.acceleration,
                limits.jerk};
}

}  // namespace detail

double LimitUse::worst() const {
  return velocity.size() == 0 ? 0 : std::max(velocity.maxCoeff(), acceleration.maxCoeff());
}

LimitUse check_limits(const Trajectory& trajectory, const JointLimits& limits, double dt) {
  const JointVec zero = JointVec::Zero(trajectory.dof());
  LimitUse use{zero, zero, zero, zero};
  JointVec a_before;
  double t_before = 0;
  const auto samples = static_cast<long>(std::ceil(trajectory.duration() / dt));
  // All of one length: over what is left at the end, however short, a difference of accelerations
  // would be but rounding.
  const double step = samples > 0 ? trajectory.duration() / static_cast<double>(samples) : 0;
  for (long i = 0; i <= samples; ++i) {
    const double t = i < samples ? static_cast<double>(i) * step : trajectory.duration();
    const JointState x = trajectory.at(t);
    use.velocity = use.velocity.cwiseMax(x.v.cwiseAbs().cwiseQuotient(limits.velocity));
    use.acceleration = use.acceleration.cwiseMax(x.a.cwiseAbs().cwiseQuotient(limits.acceleration));
    use.position = use.position.cwiseMax(x.q - limits.upper).cwiseMax(limits.lower - x.q);
    if (t > t_before) {
      const JointVec jerk = (x.a - a_before) / (t - t_before);
      use.jerk = use.jerk.cwiseMax(jerk.cwiseAbs().cwiseQuotient(limits.jerk));
    }
    a_before = x.a;
    t_before = t;
  }
  return use;
}

JointVec check_torque(const Trajectory& trajectory, const InverseDynamics& dynamics,
                      const JointVec& torque, double dt) {
  JointVec use = JointVec::Zero(trajectory.dof());
  const auto samples = static_cast<long>(std::ceil(trajectory.duration() / dt));
  for (long i = 0; i <= samples; ++i) {
    const double t = std::min(static_cast<double>(i) * dt, trajectory.duration());
    const JointState x = trajectory.at(t);
    use = use.cwiseMax(dynamics(x.q, x.v, x.a).cwiseAbs().cwiseQuotient(torque));
  }
  return use;
}

}  // namespace mjarm
