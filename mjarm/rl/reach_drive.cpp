#include <algorithm>
#include <cmath>
#include <numbers>

#include "mjarm/control/actuation.hpp"
#include "mjarm/core/messages/reach.hpp"
#include "mjarm/rl/reach_drive_internal.hpp"

namespace mjarm::rl {
namespace {

/// How many greatest steps a reference may be ahead of its joint, so that it does not run away
/// while the joint is blocked.
constexpr double kMaxAhead = 3;

}  // namespace

Result<ReachDrive> ReachDrive::create(const Arm& arm, const ReachOptions& options, double period) {
  for (const ArmJoint& joint : arm.joints) {
    if (!joint.actuator) return fail(Errc::bad_input, text(msg::reach_no_actuator, joint.name));
    if (options.action != ReachAction::torque && servo_stiffness(*joint.actuator) <= 0) {
      return fail(Errc::bad_input, text(msg::reach_no_servo, joint.name, name(options.action)));
    }
  }
  ReachDrive drive;
  drive.arm_ = arm;
  drive.action_ = options.action;
  drive.guide_ = options.guide;
  drive.period_ = period;
  drive.lower_ = arm.limits.lower;
  drive.upper_ = arm.limits.upper;
  for (int i = 0; i < arm.dof(); ++i) {
    if (!std::isfinite(drive.lower_[i])) drive.lower_[i] = -std::numbers::pi;
    if (!std::isfinite(drive.upper_[i])) drive.upper_[i] = std::numbers::pi;
  }
  drive.speed_ = options.speed * arm.limits.velocity;
  drive.torque_ = options.torque * arm.limits.torque;
  return drive;
}

double ReachDrive::next(int joint, double action, double q, double reference) const {
  const double step = speed_[joint] * period_;
  double wanted = 0;
  switch (action_) {
    case ReachAction::joint_velocity:
      wanted = q + action * step;
      break;
    case ReachAction::joint_position:
      wanted = lower_[joint] + (action + 1) / 2 * (upper_[joint] - lower_[joint]);
      wanted = std::clamp(wanted, reference - step, reference + step);
      break;
    default:
      wanted = reference + action * step;
  }
  wanted = std::clamp(wanted, q - kMaxAhead * step, q + kMaxAhead * step);
  return std::clamp(wanted, arm_.limits.lower[joint], arm_.limits.upper[joint]);
}

/// What gives the torque that carries `bias` and friction while the joint moves at `v`.
double ReachDrive::ctrl(int joint, double bias, double q, double v) const {
  const ArmJoint& j = arm_.joints[joint];
  return ctrl_for_torque(*j.actuator, bias + j.damping * v, q, v);
}

void ReachDrive::command(std::span<const float> actions, const DriveState& now,
                         std::span<double> reference, std::span<double> ctrls) const {
  for (int i = 0; i < arm_.dof(); ++i) {
    const ArmJoint& joint = arm_.joints[i];
    const float action = std::clamp(actions[i], -1.0F, 1.0F);
    const double q = now.qpos[joint.qpos];
    const double v = now.qvel[joint.dof];
    const double bias = now.bias[joint.dof];
    double& out = ctrls[joint.actuator->id];
    if (guide_) {
      // Partly in single precision, as the tutorial computes it.
      const double share = (action + 1.0F) * 0.5F;
      out = static_cast<float>(lower_[i] + share * (upper_[i] - lower_[i]));
    } else if (action_ == ReachAction::torque) {
      out = ctrl_for_torque(*joint.actuator, bias + action * torque_[i], q, v);
    } else {
      const double from = action_ == ReachAction::joint_velocity ? q : reference[i];
      const double to = next(i, action, q, reference[i]);
      out = ctrl(i, bias, (from + to) / 2, (to - from) / period_);
      reference[i] = to;
    }
  }
}

void ReachDrive::hold(std::span<const double> q, std::span<const double> bias,
                      std::span<double> ctrls) const {
  for (int i = 0; i < arm_.dof(); ++i) {
    const ArmJoint& joint = arm_.joints[i];
    ctrls[joint.actuator->id] = ctrl(i, bias[joint.dof], q[i], 0);
  }
}

}  // namespace mjarm::rl
