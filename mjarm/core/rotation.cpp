#include "mjarm/core/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mjarm {
namespace {

/// `q` or -q, whichever has its first non-zero component (w, x, y, z) positive.
Quat with_positive_lead(const Quat& q) {
  for (const double lead : {q.w(), q.x(), q.y(), q.z()}) {
    if (lead > 0) return q;
    if (lead < 0) return Quat(-q.w(), -q.x(), -q.y(), -q.z());
  }
  return q;
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& w) {
  Eigen::Matrix3d W;
  W << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return W;
}

}  // namespace

Eigen::Matrix3d to_matrix(const Quat& q) { return q.normalized().toRotationMatrix(); }

Quat to_quat(const Eigen::Matrix3d& R) {
  // 4 q q^T has these diagonal entries; dividing by the root of the largest keeps every digit.
  const double trace = R.trace();
  const double diagonal[4] = {1 + trace, 1 - trace + 2 * R(0, 0), 1 - trace + 2 * R(1, 1),
                              1 - trace + 2 * R(2, 2)};
  const auto largest = std::max_element(diagonal, diagonal + 4) - diagonal;
  Quat q;
  switch (largest) {
    case 0:
      q = Quat(diagonal[0], R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
      break;
    case 1:
      q = Quat(R(2, 1) - R(1, 2), diagonal[1], R(0, 1) + R(1, 0), R(0, 2) + R(2, 0));
      break;
    case 2:
      q = Quat(R(0, 2) - R(2, 0), R(0, 1) + R(1, 0), diagonal[2], R(1, 2) + R(2, 1));
      break;
    default:
      q = Quat(R(1, 0) - R(0, 1), R(0, 2) + R(2, 0), R(1, 2) + R(2, 1), diagonal[3]);
  }
  return with_positive_lead(q.normalized());
}

Eigen::Matrix3d from_euler(const Eigen::Vector3d& euler) {
  const double cx = std::cos(euler.x()), sx = std::sin(euler.x());
  const double cy = std::cos(euler.y()), sy = std::sin(euler.y());
  const double cz = std::cos(euler.z()), sz = std::sin(euler.z());
  Eigen::Matrix3d R;
  R << cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx,  //
      sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx,   //
      -sy, cy * sx, cy * cx;
  return R;
}

Eigen::Vector3d to_euler(const Eigen::Matrix3d& R) {
  constexpr double kGimbalLock = 1e-13;  // cos(y) below this carries no digits of z
  const double cos_y = std::hypot(R(0, 0), R(1, 0));
  const double z = cos_y < kGimbalLock ? 0.0 : std::atan2(R(1, 0), R(0, 0));
  // x is read from Rz(z)^T R and not from the last row: so an inexact z near gimbal lock is made up
  // for by x, and the angles always rebuild R.
  const double sz = std::sin(z), cz = std::cos(z);
  const double sin_x = sz * R(0, 2) - cz * R(1, 2);
  const double cos_x = cz * R(1, 1) - sz * R(0, 1);
  return {std::atan2(sin_x, cos_x), std::atan2(-R(2, 0), cos_y), z};
}

Eigen::Vector3d rotation_log(const Eigen::Matrix3d& R) {
  const Quat q = to_quat(R);
  const double sin_half = q.vec().norm();
  if (sin_half == 0) return Eigen::Vector3d::Zero();
  return q.vec() * (2 * std::atan2(sin_half, q.w()) / sin_half);
}

Eigen::Matrix3d rotation_exp(const Eigen::Vector3d& w) {
  const double angle2 = w.squaredNorm();
  const double angle = std::sqrt(angle2);
  double a = 1 - angle2 / 6;     // sin(angle) / angle
  double b = 0.5 - angle2 / 24;  // (1 - cos(angle)) / angle^2
  if (angle > 1e-4) {
    const double sin_half = std::sin(0.5 * angle);
    a = std::sin(angle) / angle;
    b = 2 * sin_half * sin_half / angle2;
  }
  const Eigen::Matrix3d W = cross_matrix(w);
  return Eigen::Matrix3d::Identity() + a * W + b * W * W;
}

Eigen::Matrix3d rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  constexpr double kParallel = 1e-12;
  const Eigen::Vector3d a = from.normalized(), b = to.normalized();
  Eigen::Vector3d axis = a.cross(b);
  const double sine = axis.norm(), cosine = a.dot(b);
  if (sine > kParallel) {
    // Near half a turn little is left of the cross product but rounding.
    axis -= a * a.dot(axis);
    return rotation_exp(std::atan2(sine, cosine) * axis.normalized());
  }
  if (cosine > 0) return Eigen::Matrix3d::Identity();
  return rotation_exp(std::numbers::pi * a.unitOrthogonal());
}

double angle_between(const Eigen::Matrix3d& A, const Eigen::Matrix3d& B) {
  const Quat q = to_quat(A.transpose() * B);
  return 2 * std::atan2(q.vec().norm(), q.w());
}

Quat slerp(const Quat& q0, const Quat& q1, double t) {
  const Eigen::Vector4d a = q0.coeffs().normalized();
  Eigen::Vector4d b = q1.coeffs().normalized();
  if (a.dot(b) < 0) b = -b;
  // atan2 of difference and sum keeps all digits of small angles, where acos of the dot loses half.
  const double angle = 2 * std::atan2((a - b).norm(), (a + b).norm());
  Eigen::Vector4d result;
  if (angle < 1e-8) {
    result = (1 - t) * a + t * b;
  } else {
    result = (std::sin((1 - t) * angle) * a + std::sin(t * angle) * b) / std::sin(angle);
  }
  result.normalize();
  return Quat(result);
}

Pose interpolate(const Pose& X0, const Pose& X1, double t) {
  return {(1 - t) * X0.p + t * X1.p, to_matrix(slerp(to_quat(X0.R), to_quat(X1.R), t))};
}

}  // namespace mjarm
