#include "mjarm/model/arm_dynamics.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>

#include "mjarm/model/home.hpp"

namespace mjarm {

ArmDynamics::ArmDynamics(const Model& model, const Arm& arm)
    : dynamics_(model),
      friction_(arm.dof()),
      position_(home_configuration(model.raw()).begin(), home_configuration(model.raw()).end()),
      velocity_(static_cast<std::size_t>(model.nv()), 0.0),
      acceleration_(velocity_) {
  const mjModel* m = model.raw();
  for (int i = 0; i < arm.dof(); ++i) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
    qpos_.push_back(joint.qpos);
    dof_.push_back(joint.dof);
    friction_[i] = m->dof_frictionloss[joint.dof];
  }
}

JointVec ArmDynamics::inverse(const JointVec& q, const JointVec& v, const JointVec& a) {
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    position_[static_cast<std::size_t>(qpos_[k])] = q[i];
    velocity_[static_cast<std::size_t>(dof_[k])] = v[i];
    acceleration_[static_cast<std::size_t>(dof_[k])] = a[i];
  }
  JointVec torque(q.size());
  const Eigen::VectorXd& moving = dynamics_.inverse(position_, velocity_, acceleration_);
  for (Eigen::Index i = 0; i < q.size(); ++i) torque[i] = moving[dof_[static_cast<std::size_t>(i)]];
  const Eigen::VectorXd& passive = dynamics_.passive(position_, velocity_);
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    torque[i] -= passive[dof_[static_cast<std::size_t>(i)]];
    if (v[i] != 0) torque[i] += v[i] > 0 ? friction_[i] : -friction_[i];
  }
  return torque;
}

}  // namespace mjarm
