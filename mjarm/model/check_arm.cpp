#include <algorithm>
#include <cmath>

#include "mjarm/core/messages/check.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/check_internal.hpp"
#include "mjarm/model/floating_base.hpp"
#include "mjarm/model/servo_range.hpp"

namespace mjarm {
namespace {

/// A hinge of an arm that turns less is hardly meant to turn [rad].
constexpr double kTinyRange = 0.1;

/// The element that says where a joint ends.
Place limit_place(const CheckContext& context, const std::string& joint) {
  const Description& description = context.description;
  const SourceNode* node = description.find("worldbody", "joint", joint);
  if (description.is_urdf() || node == nullptr) return description.joint(joint);
  const auto range = description.setting(*node, "range");
  if (!range) return description.joint(joint);
  Place place = description.joint(joint);
  place.file = *range->node->file;
  place.line = range->node->element->GetLineNum();
  return place;
}

/// The range that is written for a joint which has no limits; empty where there is none.
std::vector<double> unused_range(const CheckContext& context, const std::string& joint) {
  const SourceNode* node = context.description.find("worldbody", "joint", joint);
  if (node == nullptr) return {};
  const auto range = context.description.setting(*node, "range");
  return range ? numbers_in(range->value) : std::vector<double>();
}

void tell_no_limits(const CheckContext& context, const Place& place, const std::string& joint) {
  const std::vector<double> range = unused_range(context, joint);
  const bool any = range.size() == 2;
  // MuJoCo takes such a range for none where nothing says that the joint is limited.
  const std::string what = !any ? text(msg::check_limits_missing)
                           : range[0] >= range[1]
                               ? text(msg::check_range_reversed, range[0], range[1])
                               : text(msg::check_limits_ignored);
  context.add(any ? CheckCode::limits_ignored : CheckCode::limits_missing, Grade::warning, place,
              what);
}

void check_limits(const CheckContext& context, int i) {
  const Arm& arm = *context.arm;
  const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
  const double range = arm.limits.upper[i] - arm.limits.lower[i];
  const Place place = limit_place(context, joint.name);
  if (!std::isfinite(range)) {
    if (context.description.is_urdf()) return;  // told from the text
    tell_no_limits(context, place, joint.name);
  } else if (joint.type == JointType::hinge && range < kTinyRange) {
    context.add(CheckCode::range_tiny, Grade::warning, place,
                text(msg::check_range_tiny, range, range * 180 / 3.14159265358979));
  }
}

void check_tip(const CheckContext& context) {
  const mjModel* m = context.model->raw();
  const Arm& arm = *context.arm;
  if (mj_name2id(m, mjOBJ_SITE, arm.tip.c_str()) >= 0) return;
  const int body = mj_name2id(m, mjOBJ_BODY, arm.tip.c_str());
  if (body >= 0 && m->body_jntnum[body] == 0) return;
  context.add(CheckCode::tip_missing, Grade::warning, context.description.body(arm.tip),
              text(msg::check_tip_missing, arm.tip));
}

/// Joints beyond the arm that neither an actuator nor a coupling moves.
void check_base(const CheckContext& context) {
  const std::optional<std::string> base = floating_base(*context.model, *context.arm);
  if (!base) return;
  context.add(CheckCode::base_floats, Grade::warning, context.description.body(*base),
              text(msg::check_base_floats));
}

void check_gripper(const CheckContext& context) {
  const mjModel* m = context.model->raw();
  const Arm& arm = *context.arm;
  if (m->nactuator == 0) return;  // nothing is driven at all, and that is told
  std::vector<char> moved(static_cast<std::size_t>(m->njnt), 0);
  const auto mark_tendon = [&](int t) {
    for (int w = m->tendon_adr[t]; w < m->tendon_adr[t] + m->tendon_num[t]; ++w) {
      if (m->wrap_type[w] == mjWRAP_JOINT) moved[m->wrap_objid[w]] = 1;
    }
  };
  for (int a = 0; a < m->nactuator; ++a) {
    const int type = m->actuator_trntype[a];
    if (type == mjTRN_JOINT || type == mjTRN_JOINTINPARENT) moved[m->actuator_trnid[2 * a]] = 1;
    if (type == mjTRN_TENDON) mark_tendon(m->actuator_trnid[2 * a]);
  }
  for (int e = 0; e < m->neq; ++e) {
    if (m->eq_type[e] == mjEQ_JOINT) moved[m->eq_obj1id[e]] = 1;
    if (m->eq_type[e] == mjEQ_JOINT && m->eq_obj2id[e] >= 0) moved[m->eq_obj2id[e]] = 1;
    if (m->eq_type[e] == mjEQ_CONNECT || m->eq_type[e] == mjEQ_WELD) return;  // a linkage
  }
  const int last = mj_name2id(m, mjOBJ_JOINT, arm.joints.back().name.c_str());
  if (last < 0) return;
  for (int j = last + 1; j < m->njnt; ++j) {
    if (moved[j] || !hangs_on(m, m->jnt_bodyid[j], m->jnt_bodyid[last])) continue;
    if (m->jnt_type[j] != mjJNT_HINGE && m->jnt_type[j] != mjJNT_SLIDE) continue;
    const bool has_spring = m->jnt_stiffness[j] > 0;
    if (has_spring) continue;
    const std::string name = object_name(m, mjOBJ_JOINT, j);
    context.add(CheckCode::gripper_not_driven, Grade::warning, context.description.joint(name),
                text(msg::check_gripper_not_driven));
  }
}

}  // namespace

void check_arm(const CheckContext& context) {
  const Arm& arm = *context.arm;
  const std::string from = arm.joints.front().name;
  const std::string to = arm.joints.back().name;
  std::string gripper;
  if (arm.gripper) {
    for (const GripperDrive& drive : arm.gripper->drives) {
      gripper += (gripper.empty() ? "" : text(msg::core_comma)) + drive.actuator;
    }
  } else {
    gripper = text(msg::check_arm_no_gripper);
  }
  context.add(CheckCode::arm_found, Grade::note, context.description.joint(from),
              text(msg::check_arm_found, arm.dof(), from, to, arm.tip, gripper));
  for (int i = 0; i < arm.dof(); ++i) check_limits(context, i);
  check_base(context);
  check_tip(context);
  check_gripper(context);
}

namespace {

/// Of the joint's range: commands that use less of it, or lead farther beyond it, are of another
/// unit or of another joint.
constexpr double kLeastUsed = 0.5;
constexpr double kFarBeyond = 0.75;

Place ctrl_place(const CheckContext& context, const ArmActuator& actuator) {
  return context.description.actuator(actuator.name, {"ctrlrange"});
}

void check_ctrl_range(const CheckContext& context, int i, const ArmActuator& actuator) {
  const Arm& arm = *context.arm;
  const double lower = arm.limits.lower[i], upper = arm.limits.upper[i], joint = upper - lower;
  const ServoRange servo = servo_range(arm.joints[static_cast<std::size_t>(i)]);
  const double commanded = servo.upper - servo.lower;
  if (!(joint > 0) || !std::isfinite(joint) || !std::isfinite(commanded)) return;
  const double used = std::min(upper, servo.upper) - std::max(lower, servo.lower);
  if (used >= kLeastUsed * joint && commanded - used <= kFarBeyond * joint) return;
  context.add(CheckCode::ctrl_range_differs, Grade::warning, ctrl_place(context, actuator),
              text(msg::check_ctrl_range, actuator.ctrl_lower, actuator.ctrl_upper, lower, upper));
}

void check_servo(const CheckContext& context, int i) {
  const ArmJoint& joint = context.arm->joints[static_cast<std::size_t>(i)];
  const ArmActuator& actuator = *joint.actuator;
  const Description& description = context.description;
  if (!std::isfinite(actuator.force_lower) && !std::isfinite(actuator.force_upper) &&
      context.arm->limits.sources[static_cast<std::size_t>(i)].torque != LimitSource::file) {
    context.add(CheckCode::force_limit_missing, Grade::note, description.actuator(actuator.name),
                text(msg::check_force_missing));
  }
  if (actuator.bias[1] == 0) return;
  const double stiffness = -actuator.bias[1] * actuator.gear * actuator.gear;
  if (stiffness < 0) {
    context.add(CheckCode::servo_unstable, Grade::error,
                description.actuator(actuator.name, {"kp", "biasprm"}),
                text(msg::check_servo_unstable, stiffness));
    return;
  }
  const mjModel* m = context.model->raw();
  const bool damped =
      actuator.bias[2] < 0 || joint.damping > 0 || m->dof_frictionloss[joint.dof] > 0;
  if (!damped) {
    context.add(CheckCode::servo_undamped, Grade::warning, description.actuator(actuator.name),
                text(msg::check_servo_undamped));
  }
  check_ctrl_range(context, i, actuator);
}

/// Actuators that act on a joint directly.
int actuators_on(const mjModel* m, int joint) {
  int count = 0;
  for (int a = 0; a < m->nactuator; ++a) {
    const int type = m->actuator_trntype[a];
    count +=
        (type == mjTRN_JOINT || type == mjTRN_JOINTINPARENT) && m->actuator_trnid[2 * a] == joint;
  }
  return count;
}

}  // namespace

void check_actuators(const CheckContext& context) {
  const mjModel* m = context.model->raw();
  const Arm& arm = *context.arm;
  if (m->nactuator == 0) {
    if (context.description.is_urdf()) return;  // URDF knows none
    context.add(CheckCode::actuator_missing, Grade::note, context.description.root(),
                text(msg::check_no_actuators));
    return;
  }
  for (int i = 0; i < arm.dof(); ++i) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
    const int id = mj_name2id(m, mjOBJ_JOINT, joint.name.c_str());
    if (const int count = id >= 0 ? actuators_on(m, id) : 0; count > 1) {
      context.add(CheckCode::actuator_doubled, Grade::warning,
                  context.description.joint(joint.name), text(msg::check_actuator_doubled, count));
    } else if (!joint.actuator && count == 0) {
      context.add(CheckCode::actuator_missing, Grade::warning,
                  context.description.joint(joint.name), text(msg::check_actuator_missing));
    }
    if (joint.actuator) check_servo(context, i);
  }
}

}  // namespace mjarm
