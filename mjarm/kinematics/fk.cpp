#include "mjarm/kinematics/fk.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace mjarm {
namespace {

using Mat6N = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxDof, 6>;

/// Rodrigues' formula for a unit axis.
Eigen::Matrix3d turn(const Eigen::Vector3d& axis, double angle) noexcept {
  const double s = std::sin(angle);
  const double c = std::cos(angle);
  const Eigen::Vector3d v = (1 - c) * axis;
  Eigen::Matrix3d R;
  R << c + v.x() * axis.x(), v.x() * axis.y() - s * axis.z(), v.x() * axis.z() + s * axis.y(),
      v.y() * axis.x() + s * axis.z(), c + v.y() * axis.y(), v.y() * axis.z() - s * axis.x(),
      v.z() * axis.x() - s * axis.y(), v.z() * axis.y() + s * axis.x(), c + v.z() * axis.z();
  return R;
}

/// Carries `X` (frame P in the world) over to the moved frame of `joint`.
void advance(const ArmJoint& joint, double q, Pose& X) noexcept {
  X = X * joint.X_PJ;
  if (joint.type == JointType::hinge) {
    X.R = X.R * turn(joint.axis, q);
  } else {
    X.p += X.R * joint.axis * q;
  }
}

/// Singular values of J in any order, by one-sided Jacobi rotations of the shorter side's vectors
/// (M. R. Hestenes, J. SIAM 6 (1958) 51): as many as the smaller of 6 and dof; full relative
/// accuracy, so that 0 comes out as 0.
Eigen::Matrix<double, 6, 1> singular_values(const Jacobian& J, int& count) noexcept {
  Mat6N A;
  if (J.cols() >= 6) {
    A = J.transpose();
  } else {
    A = J;
  }
  count = static_cast<int>(A.cols());
  for (int sweep = 0; sweep < 40; ++sweep) {
    bool changed = false;
    for (int i = 0; i < count; ++i) {
      for (int j = i + 1; j < count; ++j) {
        const double a = A.col(i).squaredNorm();
        const double b = A.col(j).squaredNorm();
        const double d = A.col(i).dot(A.col(j));
        if (std::abs(d) <= 1e-15 * std::sqrt(a * b)) continue;
        changed = true;
        const double zeta = (b - a) / (2 * d);
        const double t = std::copysign(1.0, zeta) / (std::abs(zeta) + std::hypot(1.0, zeta));
        const double c = 1 / std::hypot(1.0, t);
        for (Eigen::Index row = 0; row < A.rows(); ++row) {
          const double x = A(row, i);
          const double y = A(row, j);
          A(row, i) = c * (x - t * y);
          A(row, j) = c * (t * x + y);
        }
      }
    }
    if (!changed) break;
  }
  Eigen::Matrix<double, 6, 1> values = Eigen::Matrix<double, 6, 1>::Zero();
  for (int i = 0; i < count; ++i) values[i] = A.col(i).norm();
  return values;
}

/// |det A| by elimination with row pivots: Eigen's LU takes seconds to compile.
double abs_determinant(Eigen::Matrix<double, 6, 6> A) noexcept {
  double product = 1;
  for (int k = 0; k < 6; ++k) {
    int pivot = k;
    for (int i = k + 1; i < 6; ++i) {
      if (std::abs(A(i, k)) > std::abs(A(pivot, k))) pivot = i;
    }
    if (A(pivot, k) == 0) return 0;
    if (pivot != k) {
      for (int j = k; j < 6; ++j) std::swap(A(pivot, j), A(k, j));
    }
    product *= A(k, k);
    for (int i = k + 1; i < 6; ++i) {
      const double factor = A(i, k) / A(k, k);
      for (int j = k + 1; j < 6; ++j) A(i, j) -= factor * A(k, j);
    }
  }
  return std::abs(product);
}

}  // namespace

Pose fk(const Arm& arm, std::span<const double> q) noexcept {
  assert(q.size() == arm.joints.size());
  Pose X;
  for (std::size_t i = 0; i < arm.joints.size(); ++i) advance(arm.joints[i], q[i], X);
  return X * arm.X_JT;
}

Pose fk_all(const Arm& arm, std::span<const double> q, std::span<Pose> X_WJ) noexcept {
  assert(q.size() == arm.joints.size() && X_WJ.size() >= arm.joints.size());
  Pose X;
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    advance(arm.joints[i], q[i], X);
    X_WJ[i] = X;
  }
  return X * arm.X_JT;
}

FkJacobian fk_jacobian(const Arm& arm, std::span<const double> q) noexcept {
  Pose X_WJ[kMaxDof];
  FkJacobian out;
  out.X_WT = fk_all(arm, q, X_WJ);
  out.J_W.resize(6, arm.dof());
  for (int i = 0; i < arm.dof(); ++i) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
    const Eigen::Vector3d axis_W = X_WJ[i].R * joint.axis;
    if (joint.type == JointType::hinge) {
      out.J_W.col(i) << axis_W.cross(out.X_WT.p - X_WJ[i].p), axis_W;
    } else {
      out.J_W.col(i) << axis_W, Eigen::Vector3d::Zero();
    }
  }
  return out;
}

double manipulability(const Jacobian& J) noexcept {
  if (J.cols() == 6) return abs_determinant(J);
  int count = 0;
  const Eigen::Matrix<double, 6, 1> sigma = singular_values(J, count);
  double product = 1;
  for (int i = 0; i < count; ++i) product *= sigma[i];
  return product;
}

double smallest_singular_value(const Jacobian& J) noexcept {
  int count = 0;
  const Eigen::Matrix<double, 6, 1> sigma = singular_values(J, count);
  double smallest = count > 0 ? sigma[0] : 0.0;
  for (int i = 1; i < count; ++i) smallest = std::min(smallest, sigma[i]);
  return smallest;
}

bool within_limits(const Arm& arm, std::span<const double> q, double slack) noexcept {
  if (q.size() != arm.joints.size()) return false;
  for (int i = 0; i < arm.dof(); ++i) {
    const double value = q[static_cast<std::size_t>(i)];
    // Written so that NaN is refused.
    const bool inside =
        value >= arm.limits.lower[i] + slack && value <= arm.limits.upper[i] - slack;
    if (!inside || !std::isfinite(value)) return false;
  }
  return true;
}

JointVec clamp_to_limits(const Arm& arm, std::span<const double> q) noexcept {
  assert(q.size() == arm.joints.size());
  return joint_vec(q).cwiseMax(arm.limits.lower).cwiseMin(arm.limits.upper);
}

}  // namespace mjarm
