#include "mjarm/model/held_joints.hpp"

#include <algorithm>

#include "mjarm/model/arm_parts_internal.hpp"

namespace mjarm {
namespace {

using Flags = std::vector<char>;

/// One flag a joint: of the arm or its gripper.
Flags joints_of_arm(const mjModel* m, const Arm& arm) {
  Flags own(static_cast<std::size_t>(m->njnt), 0);
  for (const ArmJoint& joint : arm.joints) own[m->dof_jntid[joint.dof]] = 1;
  if (!arm.gripper) return own;
  for (int j = 0; j < m->njnt; ++j) {
    const std::string name = object_name(m, mjOBJ_JOINT, j);
    if (std::ranges::count(arm.gripper->joints, name) > 0) own[j] = 1;
  }
  return own;
}

void mark_tendon(const mjModel* m, int tendon, Flags& joints) {
  for (int w = m->tendon_adr[tendon]; w < m->tendon_adr[tendon] + m->tendon_num[tendon]; ++w) {
    if (m->wrap_type[w] == mjWRAP_JOINT) joints[m->wrap_objid[w]] = 1;
  }
}

/// The joints between two bodies that a constraint ties together.
void mark_loop(const mjModel* m, int a, int b, Flags& joints) {
  while (a != b) {
    int& lower = a > b ? a : b;  // a parent has a smaller number than its children
    for (int k = 0; k < m->body_jntnum[lower]; ++k) joints[m->body_jntadr[lower] + k] = 1;
    lower = m->body_parentid[lower];
  }
}

/// One flag a joint: something else than an actuator of its own decides where it stands.
Flags coupled_or_sprung(const mjModel* m) {
  Flags joints(static_cast<std::size_t>(m->njnt), 0);
  for (int j = 0; j < m->njnt; ++j) joints[j] = m->jnt_stiffness[j] > 0 ? 1 : 0;
  for (int a = 0; a < m->nactuator; ++a) {
    if (m->actuator_trntype[a] == mjTRN_TENDON) mark_tendon(m, m->actuator_trnid[2 * a], joints);
  }
  for (int e = 0; e < m->neq; ++e) {
    if (m->eq_active0[e] == 0) continue;
    const int first = m->eq_obj1id[e], second = m->eq_obj2id[e];
    if (m->eq_type[e] == mjEQ_JOINT) {
      joints[first] = 1;
      if (second >= 0) joints[second] = 1;
    } else if (m->eq_type[e] == mjEQ_TENDON) {
      mark_tendon(m, first, joints);
      if (second >= 0) mark_tendon(m, second, joints);
    } else if (m->eq_type[e] == mjEQ_CONNECT || m->eq_type[e] == mjEQ_WELD) {
      const bool sites = m->eq_objtype[e] == mjOBJ_SITE;
      mark_loop(m, sites ? m->site_bodyid[first] : first, sites ? m->site_bodyid[second] : second,
                joints);
    }
  }
  return joints;
}

/// One flag a kinematic tree: its joints are a robot's. That is the arm's own tree, and others that
/// stand on the ground and have an actuator.
Flags robot_trees(const mjModel* m, const Arm& arm) {
  Flags robots(static_cast<std::size_t>(m->ntree), 0);
  for (int j = 0; j < m->njnt; ++j) {
    for (int a = 0; a < m->nactuator && robots[m->dof_treeid[m->jnt_dofadr[j]]] == 0; ++a) {
      const int type = m->actuator_trntype[a];
      const bool drives = type == mjTRN_JOINT || type == mjTRN_JOINTINPARENT;
      if (drives && m->actuator_trnid[2 * a] == j) robots[m->dof_treeid[m->jnt_dofadr[j]]] = 1;
    }
  }
  for (int j = 0; j < m->njnt; ++j) {
    if (m->jnt_type[j] == mjJNT_FREE) robots[m->dof_treeid[m->jnt_dofadr[j]]] = 0;
  }
  robots[m->dof_treeid[arm.joints.front().dof]] = 1;
  return robots;
}

HeldJoint held_joint(const mjModel* m, int j) {
  HeldJoint joint;
  joint.name = object_name(m, mjOBJ_JOINT, j);
  joint.qpos = m->jnt_qposadr[j];
  joint.dof = m->jnt_dofadr[j];
  const int type = m->jnt_type[j];
  joint.dofs = type == mjJNT_FREE ? 6 : type == mjJNT_BALL ? 3 : 1;
  joint.damping = m->dof_damping[joint.dof];
  if (joint.dofs == 1) joint.actuator = sole_actuator(m, j);
  return joint;
}

}  // namespace

std::vector<HeldJoint> held_joints(const Model& model, const Arm& arm) {
  const mjModel* m = model.raw();
  const Flags own = joints_of_arm(m, arm), robots = robot_trees(m, arm),
              coupled = coupled_or_sprung(m);
  const int last = m->dof_bodyid[arm.joints.back().dof];
  std::vector<HeldJoint> held;
  for (int j = 0; j < m->njnt; ++j) {
    if (own[j] != 0 || robots[m->dof_treeid[m->jnt_dofadr[j]]] == 0) continue;
    HeldJoint joint = held_joint(m, j);
    const bool by_design = coupled[j] != 0 || hangs_on(m, m->jnt_bodyid[j], last);
    if (joint.actuator || !by_design) held.push_back(std::move(joint));
  }
  return held;
}

}  // namespace mjarm
