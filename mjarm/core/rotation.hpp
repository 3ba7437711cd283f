#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "mjarm/core/pose.hpp"

namespace mjarm {

/// Unit quaternion. Files and command lines write it `[w, x, y, z]`.
using Quat = Eigen::Quaterniond;

/// Rotation matrix of `q`, which is normalised first; |q| must not be zero.
[[nodiscard]] Eigen::Matrix3d to_matrix(const Quat& q);

/// Unit quaternion of the rotation matrix `R`, first non-zero component positive. Exact to 1e-15
/// for every angle (largest-component branch; S. W. Shepperd, J. Guidance and Control 1 (1978)
/// 223).
[[nodiscard]] Quat to_quat(const Eigen::Matrix3d& R);

/// Rotation matrix Rz(euler.z) Ry(euler.y) Rx(euler.x): angles [rad] about the fixed axes x, y, z
/// (scipy 'xyz', URDF rpy, MuJoCo eulerseq="XYZ").
[[nodiscard]] Eigen::Matrix3d from_euler(const Eigen::Vector3d& euler);

/// Inverse of from_euler; y in [-pi/2, pi/2]. At gimbal lock z is set to 0.
[[nodiscard]] Eigen::Vector3d to_euler(const Eigen::Matrix3d& R);

/// Rotation vector (axis times angle [rad], angle in [0, pi]) of `R`, accurate near 0 and near pi.
[[nodiscard]] Eigen::Vector3d rotation_log(const Eigen::Matrix3d& R);

/// Rotation matrix of the rotation vector `w` [rad] (Rodrigues' formula, series below 1e-4).
[[nodiscard]] Eigen::Matrix3d rotation_exp(const Eigen::Vector3d& w);

/// The rotation by the smallest angle that turns the direction of `from` to that of `to`, neither
/// of them zero; where they are opposite, about some axis square to both.
[[nodiscard]] Eigen::Matrix3d rotation_between(const Eigen::Vector3d& from,
                                               const Eigen::Vector3d& to);

/// Angle [rad] in [0, pi] between two rotations, accurate for tiny angles.
[[nodiscard]] double angle_between(const Eigen::Matrix3d& A, const Eigen::Matrix3d& B);

/// Spherical interpolation on the short way, t in [0, 1]; constant angular speed, unit norm.
/// The sign of either quaternion does not matter. At exactly 180 degrees one of the two ways is
/// taken. K. Shoemake, SIGGRAPH 1985.
[[nodiscard]] Quat slerp(const Quat& q0, const Quat& q1, double t);

/// Straight line of the origin, slerp of the rotation, t in [0, 1].
[[nodiscard]] Pose interpolate(const Pose& X0, const Pose& X1, double t);

}  // namespace mjarm
