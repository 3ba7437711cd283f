#include "mjarm/control/impedance.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "mjarm/core/rotation.hpp"

namespace mjarm {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Added to the mobility of the tool [1/kg], so that its inertia has a bound at singularities. So
/// little that a posture's pull on the tool stays below what can be measured.
constexpr double kLeastMobility = 1e-9;

/// D with D = 2 ratio L sqrt(S) L^T for inertia = L L^T and K = L S L^T in the eigenbasis: every
/// mode of (inertia, K) gets the damping ratio.
Matrix6 damping_matrix(const Matrix6& inertia, const Vector6& stiffness, double ratio) {
  const Matrix6 K = stiffness.asDiagonal();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6> modes(K, inertia);
  // With V^T inertia V = 1 and V^T K V = S: inertia = W W^T and K = W S W^T, where W = inertia V.
  const Matrix6 W = inertia * modes.eigenvectors();
  const Vector6 roots = modes.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return 2 * ratio * W * roots.asDiagonal() * W.transpose();
}

}  // namespace

JointVec joint_spring(const Impedance& impedance, const ImpedanceState& state,
                      const Eigen::MatrixXd& mass) {
  const double k = impedance.joint_stiffness;
  const JointVec damping = 2 * impedance.damping_ratio * (k * mass.diagonal()).cwiseSqrt();
  return k * (state.q_ref - state.q) + damping.cwiseProduct(state.v_ref - state.v);
}

JointVec tool_spring(const Impedance& impedance, const ImpedanceState& state,
                     const Eigen::MatrixXd& mass, const LinkChain& links) {
  const FkJacobian at = fk_jacobian(links, view(state.q));
  const Pose wanted = fk(links, view(state.q_ref));
  const Eigen::MatrixXd J = at.J_W;
  const Eigen::LDLT<Eigen::MatrixXd> inverse(mass);
  const Eigen::MatrixXd per_force = inverse.solve(J.transpose());  // M^-1 J^T
  const Matrix6 mobility = J * per_force + kLeastMobility * Matrix6::Identity();
  const Matrix6 inertia = mobility.ldlt().solve(Matrix6::Identity());

  Vector6 stiffness, error;
  stiffness << Eigen::Vector3d::Constant(impedance.tool_stiffness),
      Eigen::Vector3d::Constant(impedance.tool_turn_stiffness);
  error << wanted.p - at.X_WT.p, rotation_log(wanted.R * at.X_WT.R.transpose());
  const JointVec v_error = state.v_ref - state.v;
  const Vector6 force =
      stiffness.cwiseProduct(error) +
      damping_matrix(0.5 * (inertia + inertia.transpose()), stiffness, impedance.damping_ratio) *
          (J * v_error);
  const JointVec torque = J.transpose() * force;
  if (state.q.size() <= 6) return torque;

  const double k = impedance.posture_stiffness;
  const JointVec damping = 2 * impedance.damping_ratio * (k * mass.diagonal()).cwiseSqrt();
  const JointVec posture = k * (state.q_ref - state.q) + damping.cwiseProduct(v_error);
  // (1 - J^T J#^T) posture with J# = M^-1 J^T inertia: no acceleration of the tool comes of it.
  const Vector6 at_tool = inertia * (per_force.transpose() * posture);
  return torque + posture - JointVec(J.transpose() * at_tool);
}

}  // namespace mjarm
