// Inverse kinematics of our own: damped least squares with terms for the limits, beside IkSolver.
#include <Eigen/Dense>
#include <algorithm>
#include <cstdio>
#include <optional>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/robot.hpp"

namespace {

using Answer = std::optional<mjarm::JointVec>;

Answer own_ik(const mjarm::Arm& arm, const mjarm::Pose& goal, double weight) {
  mjarm::JointVec q = arm.home;
  for (int round = 0; round < 200; ++round) {
    const mjarm::FkJacobian now = mjarm::fk_jacobian(arm, mjarm::as_span(q));
    Eigen::Matrix<double, 6, 1> error;
    error << goal.p - now.X_WT.p, mjarm::rotation_log(goal.R * now.X_WT.R.transpose());
    const Eigen::VectorXd beyond = mjarm::clamp_to_limits(arm, mjarm::as_span(q)) - q;
    if (error.norm() < 1e-6 && weight * beyond.norm() < 1e-6) return q;
    // The normal equations of: J step = error, step = beyond where a limit is broken, 0.05 step = 0
    Eigen::MatrixXd A = now.J_W.transpose() * now.J_W;
    Eigen::VectorXd b = now.J_W.transpose() * error + weight * weight * beyond;
    A.diagonal().array() += 0.05 * 0.05 + weight * weight * (beyond.array() != 0).cast<double>();
    const Eigen::VectorXd step = A.ldlt().solve(b);
    q += step * std::min(1.0, 0.3 / step.lpNorm<Eigen::Infinity>());
  }
  return std::nullopt;
}

}  // namespace

int main() {
  const auto robot = mjarm::load_robot("panda");
  if (!robot) return std::fprintf(stderr, "%s\n", robot.error().what.c_str()), 1;
  const mjarm::Arm& arm = robot->arm;
  const mjarm::IkSolver ik(arm);
  mjarm::Rng rng(1);
  const char* const names[] = {"own", "own + limits", "IkSolver"};
  int found[3] = {}, inside[3] = {};
  for (int i = 0; i < 100; ++i) {
    mjarm::JointVec q = arm.limits.lower;
    for (int j = 0; j < arm.dof(); ++j) q[j] = rng.uniform(q[j], arm.limits.upper[j]);
    const mjarm::Pose goal = mjarm::fk(arm, mjarm::as_span(q));  // so it can be reached
    Answer answers[] = {own_ik(arm, goal, 0), own_ik(arm, goal, 1), {}};
    if (const auto answer = ik.solve(goal, mjarm::as_span(arm.home))) answers[2] = answer->q;
    for (int k = 0; k < 3; ++k) {
      found[k] += answers[k].has_value();
      inside[k] += answers[k] && mjarm::within_limits(arm, mjarm::as_span(*answers[k]), -1e-5);
    }
  }
  for (int k = 0; k < 3; ++k) {
    std::printf("%-12s %3d of 100 found, %3d within the limits\n", names[k], found[k], inside[k]);
  }
  return inside[2] == 100 ? 0 : 1;
}
