#include "mjarm/kinematics/chain.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/core/units.hpp"
#include "mjarm/kinematics/trig_internal.hpp"

namespace mjarm {
namespace {

/// A rotation that carries z to the unit vector `axis`; exact for the axes of the frame.
Eigen::Matrix3d frame_with_z(const Eigen::Vector3d& axis) {
  Eigen::Index smallest = 0;
  axis.cwiseAbs().minCoeff(&smallest);
  const Eigen::Vector3d z = axis.normalized();
  const Eigen::Vector3d x = Eigen::Vector3d::Unit(smallest).cross(z).normalized();
  Eigen::Matrix3d R;
  R << x, z.cross(x), z;
  return R;
}

}  // namespace

Chain::Chain(const Arm& arm) {
  if (arm.dof() < 1 || arm.dof() > kMaxDof) return;
  dof = arm.dof();
  Eigen::Matrix3d R_before = Eigen::Matrix3d::Identity();
  for (int i = 0; i < dof; ++i) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
    const Eigen::Matrix3d R_JZ = frame_with_z(joint.axis);
    X_PJ[i] = {R_before.transpose() * joint.X_PJ.p, R_before.transpose() * joint.X_PJ.R * R_JZ};
    R_before = R_JZ;
    slide[i] = joint.type == JointType::slide;
    lower[i] = arm.limits.lower[i];
    upper[i] = arm.limits.upper[i];
    full_turn[i] = !slide[i] && upper[i] - lower[i] >= kFullTurn - 1e-12;
  }
  X_JT = {R_before.transpose() * arm.X_JT.p, R_before.transpose() * arm.X_JT.R};
}

Pose Chain::fk(const double* q) const noexcept {
  Pose X;
  Eigen::Matrix3d& R = X.R;
  for (int i = 0; i < dof; ++i) {
    const Pose& step = X_PJ[static_cast<std::size_t>(i)];
    double turned[3][3];
    for (int k = 0; k < 3; ++k) {
      X.p[k] += R(k, 0) * step.p[0] + R(k, 1) * step.p[1] + R(k, 2) * step.p[2];
      for (int j = 0; j < 3; ++j) {
        turned[j][k] = R(k, 0) * step.R(0, j) + R(k, 1) * step.R(1, j) + R(k, 2) * step.R(2, j);
      }
    }
    const bool slides = slide[static_cast<std::size_t>(i)];
    const auto [s, c] = detail::sin_cos(slides ? 0 : q[i]);
    for (int k = 0; k < 3; ++k) {
      R(k, 0) = c * turned[0][k] + s * turned[1][k];
      R(k, 1) = c * turned[1][k] - s * turned[0][k];
      R(k, 2) = turned[2][k];
      if (slides) X.p[k] += q[i] * turned[2][k];
    }
  }
  return X * X_JT;
}

double nearest_winding(const Chain& chain, int i, double q, double q_near) noexcept {
  if (!chain.full_turn[i]) return q;
  q += kFullTurn * std::round((q_near - q) / kFullTurn);
  if (q > chain.upper[i]) q -= kFullTurn;
  if (q < chain.lower[i]) q += kFullTurn;
  // A range of exactly one revolution leaves a rounding error at its ends.
  return std::min(std::max(q, chain.lower[i]), chain.upper[i]);
}

JointVec unwind(const Chain& chain, const JointVec& q, const JointVec& q_near) noexcept {
  JointVec out(chain.dof);
  for (int i = 0; i < chain.dof; ++i) out[i] = nearest_winding(chain, i, q[i], q_near[i]);
  return out;
}

}  // namespace mjarm
