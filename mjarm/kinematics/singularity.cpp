#include "mjarm/kinematics/singularity.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "mjarm/core/messages/kinematics.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {

std::string_view name(SingularKind kind) noexcept {
  switch (kind) {
    case SingularKind::none:
      return "none";
    case SingularKind::shoulder:
      return "shoulder";
    case SingularKind::elbow:
      return "elbow";
    case SingularKind::wrist:
      return "wrist";
    case SingularKind::other:
      return "other";
  }
  return "other";
}

std::string describe(SingularKind kind) {
  switch (kind) {
    case SingularKind::none:
      return "";
    case SingularKind::shoulder:
      return text(msg::kinematics_shoulder);
    case SingularKind::elbow:
      return text(msg::kinematics_elbow);
    case SingularKind::wrist:
      return text(msg::kinematics_wrist);
    case SingularKind::other:
      break;
  }
  return text(msg::kinematics_other_part);
}

namespace {

/// Joint motion of unit length that moves the tool least: the eigenvector of J^T J to its smallest
/// eigenvalue, by inverse iteration.
JointVec least_motion(const Jacobian& J) noexcept {
  using Square = Eigen::Matrix<double, 6, 6>;
  const Eigen::Matrix<double, 6, 6> J6 = J;
  const Eigen::LDLT<Square> solver(J6.transpose() * J6 + 1e-12 * Square::Identity());
  Eigen::Matrix<double, 6, 1> v(0.61, 0.43, -0.37, 0.29, 0.53, -0.31);
  for (int i = 0; i < 20; ++i) v = solver.solve(v).normalized();
  return v;
}

/// The motion that is lost shows which part is singular: a wrist turns without the arm, a stretched
/// elbow without joint 1.
SingularKind kind_of(const SixAxis& form, const JointVec& motion) noexcept {
  constexpr double kMoves = 0.05;
  const auto moves = [&](int joint) { return std::abs(motion[joint]) > kMoves; };
  if (moves(0)) return SingularKind::shoulder;
  const bool wrist = form.is_parallel() ? moves(5) : !moves(1) && !moves(2);
  return wrist ? SingularKind::wrist : SingularKind::elbow;
}

}  // namespace

Singularity singularity(const IkSolver& ik, std::span<const double> q, double near) noexcept {
  const FkJacobian at = fk_jacobian(ik.arm(), q);
  Singularity out;
  out.smallest = smallest_singular_value(at.J_W);
  if (out.smallest > near) return out;
  out.kind = ik.six_axis() ? kind_of(*ik.six_axis(), least_motion(at.J_W)) : SingularKind::other;
  return out;
}

}  // namespace mjarm
