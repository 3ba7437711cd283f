#include "mjarm/kinematics/self_motion.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <optional>

#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik_search_internal.hpp"

namespace mjarm {
namespace {

using detail::Descent;
using detail::DescentOptions;
using detail::IkGoal;

/// The cost of a configuration under one goal, to be lowered.
class Cost {
 public:
  Cost(const IkSolver& ik, const SelfMotionOptions& options) : ik_(ik), options_(options) {}

  [[nodiscard]] double value(const JointVec& q) const {
    switch (options_.goal) {
      case PostureGoal::near_posture:
        return (q - options_.posture).squaredNorm();
      case PostureGoal::away_from_limits:
        return limits(q).squaredNorm();
      case PostureGoal::manipulability:
        break;
    }
    return -std::log(manipulability(fk_jacobian(ik_.arm(), view(q)).J_W) + 1e-12);
  }

  /// By central differences: the costs are smooth, and a step costs more than they do.
  [[nodiscard]] JointVec gradient(const JointVec& q) const {
    constexpr double h = 1e-5;
    JointVec out(q.size());
    JointVec moved = q;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      moved[i] = q[i] + h;
      const double above = value(moved);
      moved[i] = q[i] - h;
      out[i] = (above - value(moved)) / (2 * h);
      moved[i] = q[i];
    }
    return out;
  }

 private:
  /// Distance from the middle of the limits in units of half their width; 0 for joints without.
  [[nodiscard]] JointVec limits(const JointVec& q) const {
    const JointLimits& limits = ik_.arm().limits;
    JointVec out = JointVec::Zero(q.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const double half = 0.5 * (limits.upper[i] - limits.lower[i]);
      if (std::isfinite(half) && half > 0) out[i] = (q[i] - limits.lower[i]) / half - 1;
    }
    return out;
  }

  const IkSolver& ik_;
  const SelfMotionOptions& options_;
};

/// The part of `direction` that leaves the task alone, joints held at their limits left out.
JointVec project(const IkSolver& ik, const JointVec& q, JointVec direction) {
  const bool pose = ik.options().task == IkTask::pose;
  Jacobian J = fk_jacobian(ik.arm(), view(q)).J_W;
  if (!pose) J.bottomRows<3>().setZero();
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const JointLimits& limits = ik.arm().limits;
    const bool held = (q[i] <= limits.lower[i] && direction[i] < 0) ||
                      (q[i] >= limits.upper[i] && direction[i] > 0);
    if (!held) continue;
    direction[i] = 0;
    J.col(i).setZero();
  }
  const Eigen::Matrix<double, 6, 6> A =
      J * J.transpose() + 1e-10 * Eigen::Matrix<double, 6, 6>::Identity();
  const Eigen::Matrix<double, 6, 1> twist = J * direction;
  return direction - J.transpose() * A.ldlt().solve(twist);
}

/// The step along `direction`, halved until the tool can be brought back to a lower cost.
std::optional<Descent> step(const IkSolver& ik, const Pose& X_WT, const JointVec& q,
                            const JointVec& direction, const Cost& cost) {
  constexpr double kLongest = 0.2;  // [rad or m] of the joint that moves most
  DescentOptions back = detail::descent_options(ik.options(), ik.length());
  back.max_iterations = 6;
  const double before = cost.value(q);
  double share = std::min(1.0, kLongest / direction.cwiseAbs().maxCoeff());
  for (int halving = 0; halving < 8; ++halving, share *= 0.5) {
    const JointVec wish = clamp_to_limits(ik.arm(), view(JointVec(q + share * direction)));
    Descent met = detail::descend(ik.chain(), X_WT, wish, back);
    if (!met.converged || !within_limits(ik.arm(), view(met.q))) continue;
    if (!(cost.value(met.q) < before)) continue;
    if (ik.options().valid && !ik.options().valid(view(met.q))) continue;
    return met;
  }
  return std::nullopt;
}

}  // namespace

Result<IkSolution, IkFailure> settle(const IkSolver& ik, const Pose& X_WT,
                                     std::span<const double> from,
                                     const SelfMotionOptions& options) noexcept {
  IkFailure bad;
  bad.code = IkErrc::bad_input;
  bad.best.q = JointVec::Zero(ik.arm().dof());
  IkGoal goal;
  if (!detail::check_goal(ik.chain(), ik.options(), X_WT, from, goal)) return fail(bad);
  const bool posture_fits = options.posture.size() == ik.arm().dof() && options.posture.allFinite();
  if (options.goal == PostureGoal::near_posture && !posture_fits) return fail(bad);
  if (options.max_steps < 0 || !(options.tolerance > 0)) return fail(bad);
  DescentOptions still = detail::descent_options(ik.options(), ik.length());
  still.max_iterations = 0;
  Descent met = detail::descend(ik.chain(), goal.X_WT, goal.seed, still);
  if (!met.converged) return fail(bad);
  const Cost cost(ik, options);
  int steps = 0;
  for (; steps < options.max_steps; ++steps) {
    const JointVec direction = project(ik, met.q, -cost.gradient(met.q));
    if (!(direction.cwiseAbs().maxCoeff() > options.tolerance)) break;
    const std::optional<Descent> next = step(ik, goal.X_WT, met.q, direction, cost);
    if (!next) break;
    const double moved = (next->q - met.q).cwiseAbs().maxCoeff();
    met = *next;
    if (moved < options.tolerance) break;
  }
  return IkSolution{met.q, met.pos_err, met.rot_err, steps, 0};
}

}  // namespace mjarm
