#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace mjarm {

/// Pose of a frame B in a frame A, written `X_AB`: p_A = R_AB p_B + p_AB.
struct Pose {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();      ///< [m] origin of B in A
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  ///< rotation matrix, columns = axes of B in A

  /// X_AC = X_AB * X_BC.
  [[nodiscard]] Pose operator*(const Pose& X_BC) const { return {R * X_BC.p + p, R * X_BC.R}; }
  /// Point given in B, seen in A [m].
  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& p_B) const { return R * p_B + p; }
  /// X_BA.
  [[nodiscard]] Pose inverse() const { return {-(R.transpose() * p), R.transpose()}; }
};

}  // namespace mjarm
