#include <cassert>

#include "mjarm/core/messages/sim.hpp"
#include "mjarm/sim/raw_internal.hpp"

namespace mjarm::raw {
namespace {

Pose pose_of(const mjtNum* p, const mjtNum* R) {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  return {Eigen::Map<const Eigen::Vector3d>(p), Eigen::Map<const RowMajor>(R)};
}

std::string joint_name(const mjModel& m, int joint) {
  const char* name = mj_id2name(&m, mjOBJ_JOINT, joint);
  return name != nullptr ? name : "joint " + std::to_string(joint);
}

}  // namespace

Pose tool_pose(const mjModel& m, const mjData& d, const Arm& arm) {
  const int site = mj_name2id(&m, mjOBJ_SITE, arm.tip.c_str());
  if (site >= 0) return pose_of(d.site_xpos + 3 * site, d.site_xmat + 9 * site);
  const int body = mj_name2id(&m, mjOBJ_BODY, arm.tip.c_str());
  assert(body >= 0 && "the arm is of another model");
  return pose_of(d.xpos + 3 * body, d.xmat + 9 * body);
}

std::string dof_name(const mjModel& m, int dof) {
  if (dof < 0 || dof >= m.nv) return "dof " + std::to_string(dof);
  return joint_name(m, m.dof_jntid[dof]);
}

std::string qpos_name(const mjModel& m, int index) {
  int joint = -1;
  while (joint + 1 < m.njnt && m.jnt_qposadr[joint + 1] <= index) ++joint;
  return joint >= 0 ? joint_name(m, joint) : "qpos " + std::to_string(index);
}

std::string geom_name(const mjModel& m, int geom) {
  if (geom < 0) return "flex";
  const char* name = mj_id2name(&m, mjOBJ_GEOM, geom);
  if (name == nullptr) name = mj_id2name(&m, mjOBJ_BODY, m.geom_bodyid[geom]);
  return name != nullptr ? name : "geom " + std::to_string(geom);
}

bool unstable(const mjWarningStat* warnings) {
  return warnings[mjWARN_BADQPOS].number > 0 || warnings[mjWARN_BADQVEL].number > 0 ||
         warnings[mjWARN_BADQACC].number > 0;
}

std::string instability(const mjModel& m, const mjWarningStat* warnings, double time) {
  std::string joint;
  if (warnings[mjWARN_BADQACC].number > 0) {
    joint = dof_name(m, warnings[mjWARN_BADQACC].lastinfo);
  } else if (warnings[mjWARN_BADQVEL].number > 0) {
    joint = dof_name(m, warnings[mjWARN_BADQVEL].lastinfo);
  } else {
    joint = qpos_name(m, warnings[mjWARN_BADQPOS].lastinfo);
  }
  return text(msg::sim_unstable, time, joint, m.opt.timestep);
}

}  // namespace mjarm::raw
