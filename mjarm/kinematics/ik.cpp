#include "mjarm/kinematics/ik.hpp"

#include <utility>

#include "mjarm/core/messages/kinematics.hpp"
#include "mjarm/kinematics/branch_choice_internal.hpp"
#include "mjarm/kinematics/numeric_search_internal.hpp"

namespace mjarm {
namespace {

using detail::BranchChoice;
using detail::Branches;
using detail::BranchQuery;
using detail::ClosedForm;
using detail::IkGoal;

// [rad and m] A smaller defect of the closed form moves branches by less than 1e-3 rad even where
// two of them meet, so that none is lost.
constexpr double kNoDefect = 1e-8;

IkFailure failure_of(const ReachBreach& breach, const IkSolution& best) noexcept {
  IkFailure out;
  out.code = breach.shape == ReachShape::outer_sphere ? IkErrc::out_of_reach : IkErrc::inner_void;
  out.best = best;
  out.amount = breach.amount;
  out.bound = breach.bound;
  out.shape = breach.shape;
  return out;
}

/// Asks the closed form; where that has no answer and is no proof, the numeric search.
Result<IkSolution, IkFailure> solve_six(const IkSolver& ik, const IkGoal& goal) noexcept {
  const IkOptions& options = ik.options();
  Branches branches;
  const BranchQuery query{goal.X_WT, goal.seed.data(), options.pos_tol, options.rot_tol};
  ClosedForm::branches(*ik.six_axis(), query, branches);
  BranchChoice choice(ik, goal);
  if (const auto solution = choice.nearest(branches)) return *solution;
  if (branches.complete && branches.count > 0) return fail(choice.failure(branches));
  if (const auto breach = ik.reach().check(goal.X_WT)) {
    return fail(failure_of(*breach, choice.failure(branches).best));
  }
  if (branches.complete) return fail(choice.failure(branches));
  return search_numeric(ik.chain(), options, ik.length(), goal);
}

/// Likewise for seven axes: the answer nearest to the seed, or, where that is refused, the nearest
/// one of those met along the whole range of the last joint.
Result<IkSolution, IkFailure> solve_seven(const IkSolver& ik, const IkGoal& goal) noexcept {
  const IkOptions& options = ik.options();
  BranchChoice choice(ik, goal);
  BranchQuery query{goal.X_WT, goal.seed.data(), options.pos_tol, options.rot_tol};
  Branches branches;
  ClosedForm::branches(*ik.seven_axis(), query, branches);
  if (const auto breach = ik.reach().check(goal.X_WT)) {
    return fail(failure_of(*breach, choice.failure(branches).best));
  }
  if (const auto solution = choice.nearest(branches)) return *solution;
  if (choice.has_refused()) {
    query.all = true;
    branches.count = 0;
    ClosedForm::branches(*ik.seven_axis(), query, branches);
    if (const auto solution = choice.nearest(branches)) return *solution;
  }
  if (branches.complete) return fail(choice.failure(branches));
  return search_numeric(ik.chain(), options, ik.length(), goal);
}

}  // namespace

Result<IkSolver> IkSolver::create(const Arm& arm, IkOptions options) {
  if (const char* const option = detail::option_out_of_range(options)) {
    return fail(Errc::bad_input, text(msg::kinematics_ik_option, option));
  }
  IkSolver out(arm, std::move(options));
  if (out.chain_.dof == 0) {
    return fail(Errc::bad_input, text(msg::kinematics_arm_joints, arm.name, arm.dof(), kMaxDof));
  }
  return out;
}

IkSolver::IkSolver(const Arm& arm, IkOptions options)
    : arm_(arm),
      options_(std::move(options)),
      chain_(arm),
      links_(chain_),
      reach_(arm),
      length_(detail::characteristic_length(chain_)) {
  if (!options_.closed_form || options_.task != IkTask::pose) return;
  six_ = SixAxis::recognise(chain_);
  seven_ = SevenAxis::recognise(chain_);
  if (!six_ || six_->defect() > kNoDefect) general_ = GeneralSix::recognise(chain_);
}

Result<IkSolution, IkFailure> IkSolver::solve(const Pose& X_WT,
                                              std::span<const double> q_seed) const noexcept {
  IkGoal goal;
  if (!detail::check_goal(chain_, options_, X_WT, q_seed, goal)) {
    IkFailure failure;
    failure.code = IkErrc::bad_input;
    failure.best.q = JointVec::Zero(chain_.dof);
    return fail(failure);
  }
  if (six_) return solve_six(*this, goal);
  if (seven_) return solve_seven(*this, goal);
  const bool pose = options_.task == IkTask::pose;
  if (const auto breach = pose ? reach_.check(goal.X_WT) : reach_.check_position(goal.X_WT.p)) {
    return fail(failure_of(*breach, detail::nearest_from_seed(chain_, options_, length_, goal)));
  }
  return detail::search_numeric(chain_, options_, length_, goal);
}

}  // namespace mjarm
