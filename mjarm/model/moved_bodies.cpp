#include "mjarm/model/moved_bodies.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>

#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/home.hpp"
#include "mjarm/model/load_internal.hpp"

namespace mjarm {
namespace {

using RowMatrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// X_WB of a body, as its world stands.
Pose standing(const mjData* d, int body) {
  return {Eigen::Vector3d(d->xpos + 3 * body), Eigen::Map<const RowMatrix>(d->xmat + 9 * body)};
}

/// Frames of the joints in their bodies: the arm's frames move as its bodies do.
std::vector<Pose> frames_in_bodies(const mjModel* m, const mjData* d, const Arm& arm) {
  std::vector<Pose> out;
  Pose X_WJ;
  for (const ArmJoint& joint : arm.joints) {
    const double q = d->qpos[joint.qpos];
    X_WJ = X_WJ * joint.X_PJ;
    if (joint.type == JointType::slide) {
      X_WJ.p += X_WJ.R * (q * joint.axis);
    } else {
      X_WJ.R = X_WJ.R * Eigen::AngleAxisd(q, joint.axis).toRotationMatrix();
    }
    out.push_back(standing(d, m->dof_bodyid[joint.dof]).inverse() * X_WJ);
  }
  return out;
}

/// The last joint of the arm that moves `body`, -1 for none.
int mover(const mjModel* m, const Arm& arm, int body) {
  for (int i = arm.dof() - 1; i >= 0; --i) {
    if (hangs_on(m, body, m->dof_bodyid[arm.joints[i].dof])) return i;
  }
  return -1;
}

}  // namespace

std::vector<MovedBody> moved_bodies(const Model& model, const Arm& arm) {
  const mjModel* m = model.raw();
  const MjDataPtr data(mj_makeData(m));
  const mjData* d = data.get();
  std::ranges::copy(home_configuration(m), data->qpos);
  mj_kinematics(m, data.get());
  const std::vector<Pose> X_BJ = frames_in_bodies(m, d, arm);
  std::vector<MovedBody> out;
  for (int body = 1; body < m->nbody; ++body) {
    const int joint = mover(m, arm, body);
    if (joint < 0 || !(m->body_mass[body] > 0)) continue;
    const Pose X_WJ = standing(d, m->dof_bodyid[arm.joints[joint].dof]) * X_BJ[joint];
    const Pose X_JB = X_WJ.inverse() * standing(d, body);
    const Pose X_JI = X_WJ.inverse() * Pose{Eigen::Vector3d(d->xipos + 3 * body),
                                            Eigen::Map<const RowMatrix>(d->ximat + 9 * body)};
    const Eigen::Map<const Eigen::Vector3d> principal(m->body_inertia + 3 * body);
    out.push_back({body, joint, X_JB, m->body_mass[body], X_JI.p,
                   X_JI.R * principal.asDiagonal() * X_JI.R.transpose()});
  }
  return out;
}

Eigen::Vector3d gravity_of(const Model& model) { return Eigen::Vector3d(model.raw()->opt.gravity); }

}  // namespace mjarm
