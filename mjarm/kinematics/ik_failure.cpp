#include "mjarm/core/messages/kinematics.hpp"
#include "mjarm/kinematics/ik.hpp"

namespace mjarm {
namespace {

std::string describe_reach(const IkFailure& failure) {
  constexpr double kFar = 1e6;  // [m] beyond it nobody wants to know how far
  if (failure.amount > kFar)
    return text(msg::kinematics_far_out_of_reach, kFar / 1000, failure.bound);
  switch (failure.shape) {
    case ReachShape::cylinder:
      return text(msg::kinematics_inside_cylinder, failure.bound, failure.amount);
    case ReachShape::elbow_stretched:
      return text(msg::kinematics_elbow_stretched, failure.amount, failure.bound);
    case ReachShape::elbow_folded:
      return text(msg::kinematics_elbow_folded, failure.bound, failure.amount);
    case ReachShape::wrist_cone:
      return text(msg::kinematics_wrist_cone, failure.amount);
    case ReachShape::inner_sphere:
      return text(msg::kinematics_inside_sphere, failure.bound, failure.amount);
    case ReachShape::none:
    case ReachShape::outer_sphere:
      break;
  }
  return text(msg::kinematics_out_of_reach, failure.amount, failure.bound);
}

std::string describe_joint(const IkFailure& failure, const Arm& arm) {
  if (failure.joint < 0 || failure.joint >= arm.dof())
    return text(msg::kinematics_no_convergence, failure.best.restarts, failure.best.pos_err,
                failure.best.rot_err);
  const ArmJoint& joint = arm.joints[static_cast<std::size_t>(failure.joint)];
  const char* const unit = joint.type == JointType::slide ? "m" : "rad";
  const Msg id =
      failure.code == IkErrc::joint_limit ? msg::kinematics_joint_limit : msg::kinematics_too_far;
  return text(id, joint.name, failure.amount, unit);
}

}  // namespace

std::span<const std::string_view> ik_task_names() noexcept {
  static constexpr std::string_view kNames[] = {"pose", "position", "axis"};
  return kNames;
}

IkTask task_for(const Arm& arm) noexcept { return arm.dof() < 6 ? IkTask::position : IkTask::pose; }

std::string_view name(IkErrc code) noexcept {
  switch (code) {
    case IkErrc::out_of_reach:
      return "out_of_reach";
    case IkErrc::inner_void:
      return "inner_void";
    case IkErrc::joint_limit:
      return "joint_limit";
    case IkErrc::collision:
      return "collision";
    case IkErrc::no_convergence:
      return "no_convergence";
    case IkErrc::too_far:
      return "too_far";
    case IkErrc::bad_input:
      return "bad_input";
  }
  return "no_convergence";
}

std::string describe(const IkFailure& failure, const Arm& arm) {
  switch (failure.code) {
    case IkErrc::out_of_reach:
    case IkErrc::inner_void:
      return describe_reach(failure);
    case IkErrc::joint_limit:
    case IkErrc::too_far:
      return describe_joint(failure, arm);
    case IkErrc::collision:
      return text(msg::kinematics_collision);
    case IkErrc::bad_input:
      return text(msg::kinematics_bad_input, arm.dof());
    case IkErrc::no_convergence:
      break;
  }
  return text(msg::kinematics_no_convergence, failure.best.restarts, failure.best.pos_err,
              failure.best.rot_err);
}

}  // namespace mjarm
