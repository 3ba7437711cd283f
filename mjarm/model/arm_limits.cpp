#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/limits_table.hpp"

namespace mjarm {
namespace {

/// Largest torque that the file lets act on a joint in both directions; inf where it sets no bound.
double file_torque(const Model& model, int joint_id, const ArmJoint& joint) {
  const mjModel* m = model.raw();
  double torque = kInf;
  const auto bound = [&](double lower, double upper) {
    torque = std::min({torque, std::abs(lower), std::abs(upper)});
  };
  if (m->jnt_actfrclimited[joint_id]) {
    bound(m->jnt_actfrcrange[2 * joint_id], m->jnt_actfrcrange[2 * joint_id + 1]);
  }
  if (const double effort = model.urdf_effort_limit(joint.name); effort > 0) bound(-effort, effort);
  if (joint.actuator) {
    const ArmActuator& a = *joint.actuator;
    bound(a.gear * a.force_lower, a.gear * a.force_upper);
    const bool is_motor = a.bias[0] == 0 && a.bias[1] == 0 && a.bias[2] == 0;
    if (is_motor) bound(a.gear * a.gain * a.ctrl_lower, a.gear * a.gain * a.ctrl_upper);
  }
  return torque;
}

/// Takes the file's value if it has one, else the table's, else the standard.
void choose(double file, const double* table, double standard, double& value, LimitSource& source) {
  const bool in_file = file > 0 && std::isfinite(file);
  value = in_file ? file : table != nullptr ? *table : standard;
  source = in_file            ? LimitSource::file
           : table != nullptr ? LimitSource::table
                              : LimitSource::standard;
}

}  // namespace

std::string_view name(LimitSource source) noexcept {
  switch (source) {
    case LimitSource::file:
      return "file";
    case LimitSource::table:
      return "table";
    case LimitSource::standard:
      break;
  }
  return "default";
}

void fill_limits(const Model& model, const std::vector<int>& joints, Arm& arm) {
  const mjModel* m = model.raw();
  const KnownRobot* robot = known_robot(arm);
  JointLimits& limits = arm.limits;
  for (JointVec* vector : {&limits.lower, &limits.upper, &limits.velocity, &limits.acceleration,
                           &limits.jerk, &limits.torque}) {
    vector->resize(arm.dof());
  }
  for (int i = 0; i < arm.dof(); ++i) {
    const ArmJoint& joint = arm.joints[i];
    const int id = joints[i];
    const bool limited = m->jnt_limited[id] != 0;
    limits.lower[i] = limited ? m->jnt_range[2 * id] : -kInf;
    limits.upper[i] = limited ? m->jnt_range[2 * id + 1] : kInf;

    const StandardLimits standard = standard_limits(joint.type);
    LimitSources& from = limits.sources[i];
    const auto entry = [&](std::span<const double> KnownRobot::* list) {
      return robot != nullptr ? &(robot->*list)[i] : nullptr;
    };
    choose(model.urdf_velocity_limit(joint.name), entry(&KnownRobot::velocity), standard.velocity,
           limits.velocity[i], from.velocity);
    choose(0, entry(&KnownRobot::acceleration), standard.acceleration, limits.acceleration[i],
           from.acceleration);
    choose(0, entry(&KnownRobot::jerk), standard.jerk, limits.jerk[i], from.jerk);
    choose(file_torque(model, id, joint), entry(&KnownRobot::torque), standard.torque,
           limits.torque[i], from.torque);
  }
}

}  // namespace mjarm
