#include "mjarm/control/impedance.hpp"

#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/core/rotation.hpp"

namespace mjarm {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using PerForce = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::ColMajor, kMaxDof, 6>;

/// Added to the mobility of the tool [1/kg], so that its inertia has a bound at singularities. So
/// little that a posture's pull on the tool stays below what can be measured.
constexpr double kLeastMobility = 1e-9;

/// What the tool feels like to a hand: its inertia, and how its spring's modes are damped.
struct ToolModes {
  Matrix6 inertia;
  Matrix6 damping;
};

/// Every mode of (inertia, K) gets the damping ratio: D = 2 ratio W sqrt(S) W^T, where inertia =
/// mobility^-1 = W W^T and K = W S W^T.
ToolModes tool_modes(const Matrix6& mobility, const Matrix6& stiffness, double ratio) {
  const SymmetricEigen at = symmetric_eigen(mobility);
  const Vector6 roots = at.values.cwiseMax(kLeastMobility).cwiseSqrt();
  const Matrix6 E = at.vectors;
  const Matrix6 root = E * roots.cwiseInverse().asDiagonal() * E.transpose();  // inertia^(1/2)
  const Matrix6 back = E * roots.asDiagonal() * E.transpose();                 // its inverse
  const Matrix6 K = back * stiffness * back;
  const SymmetricEigen modes = symmetric_eigen(K);
  const Matrix6 W = root * modes.vectors;
  const Vector6 rates = modes.values.cwiseMax(0.0).cwiseSqrt();
  return {root * root, 2 * ratio * W * rates.asDiagonal() * W.transpose()};
}

/// Force of a push along `z`: its own, less what `force` of the springs and what pushes from
/// outside would move the tool along z together.
double push_along(const Eigen::Vector3d& z, Vector6 force, const ImpedanceState& state,
                  const Eigen::MatrixXd& mass, const Jacobian& J) {
  const AxialPush& push = *state.push;
  Eigen::MatrixXd moved = mass;
  if (state.implicit_mass.size() > 0) moved.diagonal() += state.implicit_mass;
  const PerForce per_force = solve_symmetric(moved, J.transpose());
  force.head<3>() += push.across_W - z.dot(push.across_W) * z;
  const Eigen::Matrix<double, 3, 6> mobility = J.topRows<3>() * per_force;
  const double along = z.dot(mobility * force);
  const double own = z.dot(mobility.leftCols<3>() * z);
  return push.force - push.damping * z.dot((J * state.v).head<3>()) -
         along / (own + kLeastMobility);
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
  const FkJacobian at = fk_jacobian(links, as_span(state.q));
  const Pose wanted = fk(links, as_span(state.q_ref));
  const Jacobian& J = at.J_W;
  const PerForce per_force = solve_symmetric(mass, J.transpose());  // M^-1 J^T
  const Matrix6 mobility = J * per_force + kLeastMobility * Matrix6::Identity();

  const Eigen::Vector3d z = wanted.R.col(2);
  Matrix6 stiffness = Matrix6::Zero();
  stiffness.diagonal() << Eigen::Vector3d::Constant(impedance.tool_stiffness),
      Eigen::Vector3d::Constant(impedance.tool_turn_stiffness);
  if (state.push) stiffness.topLeftCorner<3, 3>() -= impedance.tool_stiffness * z * z.transpose();
  Vector6 error;
  error << wanted.p + state.axial_offset * z - at.X_WT.p,
      rotation_log(wanted.R * at.X_WT.R.transpose());
  const ToolModes modes = tool_modes(mobility, stiffness, impedance.damping_ratio);
  const JointVec v_error = state.v_ref - state.v;
  Vector6 force = stiffness * error + modes.damping * (J * v_error);
  if (state.push) force.head<3>() += push_along(z, force, state, mass, J) * z;
  const JointVec torque = J.transpose() * force;
  if (state.q.size() <= 6) return torque;

  const double k = impedance.posture_stiffness;
  const JointVec damping = 2 * impedance.damping_ratio * (k * mass.diagonal()).cwiseSqrt();
  const JointVec posture = k * (state.q_ref - state.q) + damping.cwiseProduct(v_error);
  // (1 - J^T J#^T) posture with J# = M^-1 J^T inertia: no acceleration of the tool comes of it.
  const Vector6 at_tool = modes.inertia * (per_force.transpose() * posture);
  return torque + posture - JointVec(J.transpose() * at_tool);
}

}  // namespace mjarm
