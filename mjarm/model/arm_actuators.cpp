#include <algorithm>
#include <limits>

#include "mjarm/model/arm_parts_internal.hpp"

namespace mjarm {
namespace {

bool has_joint_transmission(const mjModel* m, int actuator) {
  const int type = m->actuator_trntype[actuator];
  return type == mjTRN_JOINT || type == mjTRN_JOINTINPARENT;
}

/// True where force = gain * ctrl + affine bias, without a state of its own.
bool is_plain(const mjModel* m, int a) {
  return m->actuator_ctrlnum[a] == 1 && m->actuator_outnum[a] == 1 &&
         m->actuator_dyntype[a] == mjDYN_NONE && m->actuator_gaintype[a] == mjGAIN_FIXED &&
         (m->actuator_biastype[a] == mjBIAS_NONE || m->actuator_biastype[a] == mjBIAS_AFFINE) &&
         m->actuator_plugin[a] < 0 && m->actuator_gainprm[a * mjNGAIN] != 0 &&
         m->actuator_gear[6 * m->actuator_outadr[a]] != 0;
}

ArmActuator describe_actuator(const mjModel* m, int a) {
  const int ctrl = m->actuator_ctrladr[a];
  ArmActuator actuator;
  actuator.name = object_name(m, mjOBJ_ACTUATOR, a);
  actuator.id = ctrl;
  actuator.gear = m->actuator_gear[6 * m->actuator_outadr[a]];
  actuator.gain = m->actuator_gainprm[a * mjNGAIN];
  if (m->actuator_biastype[a] == mjBIAS_AFFINE) {
    std::copy_n(m->actuator_biasprm + a * mjNBIAS, 3, actuator.bias);
  }
  const bool ctrl_limited = m->actuator_ctrllimited[ctrl] != 0;
  actuator.ctrl_lower = ctrl_limited ? m->actuator_ctrlrange[2 * ctrl] : -kInf;
  actuator.ctrl_upper = ctrl_limited ? m->actuator_ctrlrange[2 * ctrl + 1] : kInf;
  const bool force_limited = m->actuator_forcelimited[a] != 0;
  actuator.force_lower = force_limited ? m->actuator_forcerange[2 * a] : -kInf;
  actuator.force_upper = force_limited ? m->actuator_forcerange[2 * a + 1] : kInf;
  // A joint may limit what reaches it; with one drive that is a limit of the drive.
  const int joint = m->actuator_trnid[2 * a];
  if (m->jnt_actfrclimited[joint] != 0) {
    const double* range = m->jnt_actfrcrange + 2 * joint;
    const double ends[] = {range[0] / actuator.gear, range[1] / actuator.gear};
    actuator.force_lower = std::max(actuator.force_lower, std::min(ends[0], ends[1]));
    actuator.force_upper = std::min(actuator.force_upper, std::max(ends[0], ends[1]));
  }
  return actuator;
}

}  // namespace

std::optional<ArmActuator> sole_actuator(const mjModel* m, int joint) {
  std::optional<ArmActuator> sole;
  int drives = 0;
  for (int a = 0; a < m->nactuator; ++a) {
    if (!has_joint_transmission(m, a) || m->actuator_trnid[2 * a] != joint) continue;
    ++drives;
    if (is_plain(m, a)) sole = describe_actuator(m, a);
  }
  // Two drives on one joint are nothing that a single command could stand for.
  if (drives > 1) sole.reset();
  return sole;
}

void fill_actuators(const mjModel* m, const std::vector<int>& joints, Arm& arm) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    ArmJoint& joint = arm.joints[i];
    joint.actuator = sole_actuator(m, joints[i]);
    for (int a = 0; a < m->nactuator; ++a) {
      if (!has_joint_transmission(m, a) || m->actuator_trnid[2 * a] != joints[i]) continue;
      // Inertia and friction of a motor, seen through its gear.
      const double gear = m->actuator_gear[6 * m->actuator_outadr[a]];
      joint.armature += gear * gear * m->actuator_armature[a];
      joint.damping += gear * gear * m->actuator_damping[a];
    }
  }
}

}  // namespace mjarm
