#include "mjarm/control/link_errors.hpp"

#include <cmath>

#include "mjarm/kinematics/fk.hpp"

namespace mjarm {

LinkErrors::LinkErrors(const Model& model, const Arm& arm, const ModelErrors& errors)
    : arm_(arm),
      bodies_(moved_bodies(model, arm)),
      gravity_(gravity_of(model)),
      mass_(errors.mass / std::sqrt(3.0)),
      center_(errors.center / std::sqrt(3.0)),
      X_WJ_(static_cast<std::size_t>(arm.dof())),
      axis_(X_WJ_.size()),
      turn_(X_WJ_.size()),
      turning_(X_WJ_.size()),
      rise_(X_WJ_.size()),
      torques_(Eigen::MatrixXd::Zero(arm.dof(), count())) {}

/// Velocities and accelerations of the joint frames, base to tip, the base accelerated against
/// gravity (J. Luh, M. Walker, R. Paul, J. Dynamic Systems 102 (1980) 69).
void LinkErrors::move_links(const JointVec& q, const JointVec& v, const JointVec& a) {
  fk_all(arm_, as_span(q), X_WJ_);
  Eigen::Vector3d p = Eigen::Vector3d::Zero(), w = p, dw = p, rise = -gravity_;
  for (int i = 0; i < arm_.dof(); ++i) {
    const std::size_t k = static_cast<std::size_t>(i);
    const Eigen::Vector3d axis = X_WJ_[k].R * arm_.joints[i].axis;
    const Eigen::Vector3d way = X_WJ_[k].p - p;
    rise += dw.cross(way) + w.cross(w.cross(way));
    if (arm_.joints[i].type == JointType::slide) {
      rise += a[i] * axis + 2 * v[i] * w.cross(axis);
    } else {
      dw += a[i] * axis + w.cross(v[i] * axis);
      w += v[i] * axis;
    }
    p = X_WJ_[k].p;
    axis_[k] = axis;
    turn_[k] = w;
    turning_[k] = dw;
    rise_[k] = rise;
  }
}

/// A force at the origin of the frame of `joint` and a moment, as torques of the joints below.
void LinkErrors::add(Eigen::Index column, int joint, const Eigen::Vector3d& force,
                     const Eigen::Vector3d& moment) {
  const Eigen::Vector3d& p = X_WJ_[static_cast<std::size_t>(joint)].p;
  for (int j = 0; j <= joint; ++j) {
    const std::size_t k = static_cast<std::size_t>(j);
    torques_(j, column) = arm_.joints[j].type == JointType::slide
                              ? axis_[k].dot(force)
                              : axis_[k].dot(moment + (p - X_WJ_[k].p).cross(force));
  }
}

const Eigen::MatrixXd& LinkErrors::torques(const JointVec& q, const JointVec& v,
                                           const JointVec& a) {
  move_links(q, v, a);
  Eigen::Index column = 0;
  for (const MovedBody& body : bodies_) {
    const std::size_t k = static_cast<std::size_t>(body.joint);
    const Eigen::Matrix3d& R = X_WJ_[k].R;
    const Eigen::Vector3d &w = turn_[k], &dw = turning_[k];
    const Eigen::Vector3d c = R * body.center_J;
    const Eigen::Matrix3d inertia = R * body.inertia_center_J * R.transpose();
    const auto swing = [&](const Eigen::Vector3d& r) -> Eigen::Vector3d {
      return dw.cross(r) + w.cross(w.cross(r));
    };
    const Eigen::Vector3d force = body.mass * (rise_[k] + swing(c));
    const Eigen::Vector3d turned = inertia * w, spin = inertia * dw + w.cross(turned);
    add(column++, body.joint, mass_ * force, mass_ * (c.cross(force) + spin));
    for (int x = 0; x < 3; ++x) {
      const Eigen::Vector3d shift = center_ * R.col(x), more = body.mass * swing(shift);
      add(column++, body.joint, more, shift.cross(force) + c.cross(more));
    }
  }
  return torques_;
}

}  // namespace mjarm
