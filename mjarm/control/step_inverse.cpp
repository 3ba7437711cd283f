#include "mjarm/control/step_inverse.hpp"

#include <algorithm>

#include "mjarm/control/implicit_part.hpp"
#include "mjarm/core/linear_algebra.hpp"

namespace mjarm {

StepInverse::StepInverse(const Model& model, const Arm& arm)
    : rule_(step_rule(model)),
      dynamics_(model),
      mass_(JointVec::Zero(arm.dof())),
      stiffness_(JointVec::Zero(arm.dof())),
      full_(model.nv(), 0.0),
      rest_(model.nv(), 0.0) {
  for (int i = 0; i < arm.dof(); ++i) {
    const ArmJoint& joint = arm.joints[i];
    dof_.push_back(joint.dof);
    const ImplicitPart part = implicit_part(rule_, joint.dof, joint.damping, joint.actuator);
    mass_[i] = part.mass;
    stiffness_[i] = part.stiffness;
  }
}

JointVec StepInverse::rows(const Eigen::VectorXd& full) const {
  JointVec part(static_cast<Eigen::Index>(dof_.size()));
  for (Eigen::Index i = 0; i < part.size(); ++i) part[i] = full[dof_[i]];
  return part;
}

JointVec StepInverse::torque(std::span<const double> qpos, std::span<const double> qvel,
                             const JointVec& a) {
  std::fill(full_.begin(), full_.end(), 0.0);
  JointVec v(a.size());
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    full_[dof_[i]] = a[i];
    v[i] = qvel[dof_[i]];
  }
  JointVec torque = rows(dynamics_.inverse(qpos, qvel, full_));
  torque -= rows(dynamics_.passive(qpos, qvel));
  JointVec implicit = mass_.cwiseProduct(a) + rule_.timestep * stiffness_.cwiseProduct(v);
  if (rule_.integrator == Integrator::implicit) implicit += coriolis_change(qpos, qvel, a);
  return torque + implicit + friction(qpos, v, a, implicit);
}

JointVec StepInverse::friction(std::span<const double> qpos, const JointVec& v, const JointVec& a,
                               const JointVec& implicit) {
  JointVec torque = JointVec::Zero(a.size());
  const auto is_dry = [&](int dof) { return rule_.friction[dof].max > 0; };
  if (std::none_of(dof_.begin(), dof_.end(), is_dry)) return torque;
  // Constraints are solved before the integrator takes its implicit part.
  const JointVec before = a + JointVec(solve_symmetric(mass_matrix(qpos), implicit));
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    const DryFriction& dry = rule_.friction[dof_[i]];
    torque[i] = std::clamp(dry.mass * (before[i] + dry.damping * v[i]), -dry.max, dry.max);
  }
  return torque;
}

JointVec StepInverse::holding_torque(std::span<const double> qpos) {
  const JointVec gravity = rows(dynamics_.gravity(qpos));
  return gravity - rows(dynamics_.passive(qpos, rest_));
}

Eigen::MatrixXd StepInverse::mass_matrix(std::span<const double> qpos) {
  return dynamics_.mass_matrix(qpos)(dof_, dof_);
}

JointVec StepInverse::coriolis_change(std::span<const double> qpos, std::span<const double> qvel,
                                      const JointVec& a) {
  // c is a quadratic form in v (beside gravity), so its derivative along w is exactly
  // (c(v + w) - c(v - w)) / 2.
  full_.assign(qvel.begin(), qvel.end());
  for (Eigen::Index i = 0; i < a.size(); ++i) full_[dof_[i]] += rule_.timestep * a[i];
  const JointVec ahead = rows(dynamics_.bias(qpos, full_));
  for (Eigen::Index i = 0; i < a.size(); ++i) full_[dof_[i]] -= 2 * rule_.timestep * a[i];
  return 0.5 * (ahead - rows(dynamics_.bias(qpos, full_)));
}

}  // namespace mjarm
