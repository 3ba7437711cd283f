#include "mjarm/kinematics/self_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik_search_internal.hpp"

namespace mjarm {
namespace {

using detail::Descent;
using detail::DescentOptions;
using detail::IkGoal;

/// Takes the parts along the rows of J out of `direction`: pivoted Gram-Schmidt, each step twice,
/// without memory of the heap. What moves the tool by less than a millionth of what other
/// directions do counts as free.
void remove_rows(Jacobian& J, JointVec& direction) noexcept {
  double longest = 0;
  for (int k = 0; k < 6; ++k) {
    int pivot = 0;
    const double length = J.rowwise().norm().maxCoeff(&pivot);
    longest = std::max(longest, length);
    if (!(length > 1e-6 * longest)) return;
    const JointVec row = J.row(pivot).transpose() / length;
    for (int twice = 0; twice < 2; ++twice) {
      direction -= row.dot(direction) * row;
      for (int i = 0; i < 6; ++i) J.row(i) -= J.row(i).dot(row) * row.transpose();
    }
    J.row(pivot).setZero();
  }
}

/// One self-motion: the goal, where it stands and how it gets on.
class SelfMotion {
 public:
  SelfMotion(const IkSolver& ik, const IkGoal& goal, const SelfMotionOptions& options) noexcept
      : ik_(ik),
        goal_(goal),
        options_(options),
        back_(detail::descent_options(ik.options(), ik.length())) {
    set_target();
    back_.max_iterations = 0;
    at_ = detail::descend(ik_.chain(), goal_.X_WT, goal_.seed, back_);
    back_.max_iterations = kNewtonSteps;
  }

  [[nodiscard]] const Descent& at() const noexcept { return at_; }

  /// One step to where the goal is better met; how far the farthest joint moved, 0 for the end.
  double step() noexcept {
    const JointVec wanted = -gradient();
    const JointVec direction = free_part(wanted);
    const double slope = direction.cwiseAbs().maxCoeff();
    if (!(slope > kRounding * wanted.cwiseAbs().maxCoeff())) return 0;
    const double before = cost(at_.q);
    double share = std::min(2 * share_, kLongest / slope);
    for (; share * slope > 0.5 * options_.tolerance; share *= 0.5) {
      const JointVec wish = at_.q + share * direction;
      const Descent met = detail::descend(ik_.chain(), goal_.X_WT,
                                          clamp_to_limits(ik_.arm(), as_span(wish)), back_);
      const double enough = before - kEnough * share * direction.squaredNorm();
      if (!met.converged || !(cost(met.q) < enough) || !accepts(met.q)) continue;
      const double moved = (met.q - at_.q).cwiseAbs().maxCoeff();
      at_ = met;
      share_ = share;
      return moved;
    }
    return 0;
  }

 private:
  static constexpr double kLongest = 0.2;  // [rad or m] a step, of the joint that moves most
  static constexpr double kEnough = 0.1;   // share of the decrease that the slope promises
  static constexpr double kRounding = 1e-9;
  static constexpr int kNewtonSteps = 6;  // back to the pose; a step that takes more is too long

  /// Both goals about joint values are least squares: of what from where, with what weight.
  void set_target() noexcept {
    const JointLimits& limits = ik_.arm().limits;
    target_ = options_.posture;
    weight_ = JointVec::Ones(ik_.arm().dof());
    if (options_.goal == PostureGoal::near_posture) return;
    target_ = JointVec::Zero(ik_.arm().dof());
    for (Eigen::Index i = 0; i < target_.size(); ++i) {
      const double half = 0.5 * (limits.upper[i] - limits.lower[i]);
      const bool limited = std::isfinite(half) && half > 0;
      weight_[i] = limited ? 1 / (half * half) : 0;
      if (limited) target_[i] = limits.lower[i] + half;
    }
  }

  /// What is lowered.
  [[nodiscard]] double cost(const JointVec& q) const noexcept {
    if (options_.goal == PostureGoal::manipulability) {
      return -manipulability(fk_jacobian(ik_.arm(), as_span(q)).J_W);
    }
    return 0.5 * (q - target_).cwiseAbs2().dot(weight_);
  }

  [[nodiscard]] JointVec gradient() const noexcept {
    if (options_.goal != PostureGoal::manipulability) {
      return (at_.q - target_).cwiseProduct(weight_);
    }
    // By differences to one side: at a singularity, which is a cusp, both sides are alike.
    constexpr double h = 1e-4;
    const double here = cost(at_.q);
    JointVec out(at_.q.size());
    JointVec moved = at_.q;
    for (Eigen::Index i = 0; i < out.size(); ++i) {
      moved[i] = at_.q[i] + h;
      out[i] = (cost(moved) - here) / h;
      moved[i] = at_.q[i];
    }
    return out;
  }

  /// The part of `direction` that leaves the task alone; joints at a limit stay there rather than
  /// be pushed outwards.
  [[nodiscard]] JointVec free_part(JointVec direction) const noexcept {
    const FkJacobian there = fk_jacobian(ik_.arm(), as_span(at_.q));
    Jacobian J = there.J_W;
    auto turns = J.bottomRows<3>();
    if (ik_.options().task == IkTask::position) turns.setZero();
    const Eigen::Vector3d z = there.X_WT.R.col(2);
    const JointLimits& limits = ik_.arm().limits;
    for (Eigen::Index i = 0; i < direction.size(); ++i) {
      if (ik_.options().task == IkTask::axis) turns.col(i) -= turns.col(i).dot(z) * z;
      const bool held = (at_.q[i] <= limits.lower[i] && direction[i] < 0) ||
                        (at_.q[i] >= limits.upper[i] && direction[i] > 0);
      if (!held) continue;
      direction[i] = 0;
      J.col(i).setZero();
    }
    remove_rows(J, direction);
    return direction;
  }

  [[nodiscard]] bool accepts(const JointVec& q) const noexcept {
    const IkOptions& ik = ik_.options();
    return within_limits(ik_.arm(), as_span(q)) &&
           (q - goal_.seed).cwiseAbs().maxCoeff() <= ik.max_step &&
           (!ik.valid || ik.valid(as_span(q)));
  }

  const IkSolver& ik_;
  const IkGoal& goal_;
  const SelfMotionOptions& options_;
  DescentOptions back_;
  Descent at_;
  JointVec target_, weight_;
  double share_ = std::numeric_limits<double>::infinity();
};

bool make_sense(const SelfMotionOptions& options, int dof) noexcept {
  if (options.max_steps < 0 || !(options.tolerance > 0)) return false;
  if (options.goal != PostureGoal::near_posture) return true;
  return options.posture.size() == dof && options.posture.allFinite();
}

}  // namespace

Result<IkSolution, IkFailure> null_space_step(const IkSolver& ik, const Pose& X_WT,
                                              std::span<const double> from,
                                              const SelfMotionOptions& options) noexcept {
  IkFailure failure;
  failure.code = IkErrc::bad_input;
  failure.best.q = JointVec::Zero(ik.arm().dof());
  IkGoal goal;
  if (!detail::check_goal(ik.chain(), ik.options(), X_WT, from, goal)) return fail(failure);
  if (!make_sense(options, ik.arm().dof())) return fail(failure);
  SelfMotion motion(ik, goal, options);
  const Descent& at = motion.at();
  failure.best = {at.q, at.pos_err, at.rot_err};
  if (!at.converged) return fail(failure);
  if (ik.options().valid && !ik.options().valid(as_span(at.q))) {
    failure.code = IkErrc::collision;
    return fail(failure);
  }
  int steps = 0;
  while (steps < options.max_steps) {
    const double moved = motion.step();
    if (moved > 0) ++steps;
    if (moved < options.tolerance) break;
  }
  return IkSolution{at.q, at.pos_err, at.rot_err, steps, 0};
}

}  // namespace mjarm
