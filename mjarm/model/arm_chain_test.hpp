#pragma once

#include <span>

#include "mjarm/core/rotation.hpp"
#include "mjarm/model/arm.hpp"

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

}  // namespace mjarm
