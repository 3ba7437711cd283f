#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// Tool pose by composing the fields of `arm` as arm.hpp says: the plainest reading of that header.
inline Pose compose(const Arm& arm, std::span<const double> q) {
  Pose X_WP;
  for (int i = 0; i < arm.dof(); ++i) {
    const ArmJoint& joint = arm.joints[i];
    const Pose motion = joint.type == JointType::hinge
                            ? Pose{Eigen::Vector3d::Zero(), rotation_exp(q[i] * joint.axis)}
                            : Pose{q[i] * joint.axis, Eigen::Matrix3d::Identity()};
    X_WP = X_WP * joint.X_PJ * motion;
  }
  return X_WP * arm.X_JT;
}

/// Largest difference [m, and of rotation matrices] between the composed chain and MuJoCo's own
/// kinematics, over random joint values; other joints stand as in qpos0.
inline double worst_chain_error(const Model& model, const Arm& arm, Rng& rng, int draws) {
  using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const mjModel* m = model.raw();
  const std::unique_ptr<mjData, void (*)(mjData*)> d(mj_makeData(m), mj_deleteData);
  const int site = mj_name2id(m, mjOBJ_SITE, arm.tip.c_str());
  const int body = mj_name2id(m, mjOBJ_BODY, arm.tip.c_str());
  double worst = site < 0 && body < 0 ? 1e9 : 0;
  for (int n = 0; n < draws; ++n) {
    std::vector<double> q(static_cast<std::size_t>(arm.dof()));
    for (int i = 0; i < arm.dof(); ++i) {
      q[i] = rng.uniform(-3, 3);
      d->qpos[arm.joints[i].qpos] = q[i];
    }
    mj_kinematics(m, d.get());
    const double* p = site >= 0 ? d->site_xpos + 3 * site : d->xpos + 3 * body;
    const double* R = site >= 0 ? d->site_xmat + 9 * site : d->xmat + 9 * body;
    const Pose ours = compose(arm, q);
    worst = std::max({worst, (ours.p - Eigen::Vector3d(p)).norm(),
                      (ours.R - Eigen::Map<const Matrix>(R)).norm()});
  }
  return worst;
}

}  // namespace mjarm
