#include "mjarm/model/link_inertials.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>

#include "mjarm/core/rotation.hpp"
#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/home.hpp"
#include "mjarm/model/load_internal.hpp"

namespace mjarm {
namespace {

using RowMatrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// X_WJ of each joint frame, moved with the joint values of `d`.
std::vector<Pose> joint_frames(const Arm& arm, const mjData& d) {
  std::vector<Pose> out;
  Pose X;
  for (const ArmJoint& joint : arm.joints) {
    const double q = d.qpos[joint.qpos];
    const bool turns = joint.type == JointType::hinge;
    const Pose motion{turns ? Eigen::Vector3d::Zero() : Eigen::Vector3d(q * joint.axis),
                      turns ? rotation_exp(q * joint.axis) : Eigen::Matrix3d::Identity()};
    X = X * joint.X_PJ * motion;
    out.push_back(X);
  }
  return out;
}

/// Adds body `id` of the world to what is known in the frame `X_WF`.
void add_body(const mjModel& m, const mjData& d, int id, const Pose& X_WF, Inertial& out) {
  const RowMatrix R_WI = Eigen::Map<const RowMatrix>(d.ximat + 9 * id);
  const Eigen::Matrix3d R_FI = X_WF.R.transpose() * R_WI;
  const Eigen::Vector3d c = X_WF.inverse() * Eigen::Vector3d(d.xipos + 3 * id);
  const double mass = m.body_mass[id];
  out.mass += mass;
  out.moment += mass * c;
  out.inertia += R_FI * Eigen::Vector3d(m.body_inertia + 3 * id).asDiagonal() * R_FI.transpose() +
                 mass * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
}

}  // namespace

std::vector<Inertial> link_inertials(const Model& model, const Arm& arm) {
  const mjModel& m = *model.raw();
  const MjDataPtr d(mj_makeData(&m));
  std::ranges::copy(home_configuration(&m), d->qpos);
  mj_kinematics(&m, d.get());
  const std::vector<Pose> X_WJ = joint_frames(arm, *d);
  std::vector<Inertial> out(X_WJ.size());
  for (int body = 1; body < m.nbody; ++body) {
    // Joints of one body follow each other: the last of them moves it.
    for (std::size_t i = X_WJ.size(); i-- > 0;) {
      if (!hangs_on(&m, body, m.dof_bodyid[arm.joints[i].dof])) continue;
      add_body(m, *d, body, X_WJ[i], out[i]);
      break;
    }
  }
  return out;
}

Eigen::Vector3d gravity_of(const Model& model) { return Eigen::Vector3d(model.raw()->opt.gravity); }

}  // namespace mjarm
