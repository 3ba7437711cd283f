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

constexpr double kNearLimits = 0.2;  // [rad] a breach of limits that may be one by missing a way
constexpr double kSingular = 0.02;   // smallest singular value of the Jacobian, [mixed units]

IkFailure failure_of(const ReachBreach& breach, const IkSolution& best) noexcept {
  IkFailure out;
  out.code = breach.shape == ReachShape::outer_sphere ? IkErrc::out_of_reach : IkErrc::inner_void;
  out.best = best;
  out.amount = breach.amount;
  out.bound = breach.bound;
  out.shape = breach.shape;
  return out;
}

/// True where a form says why, and the search beside it has met nothing that says otherwise.
bool is_told(const IkFailure& form, const IkFailure& search) noexcept {
  if (form.shape != ReachShape::none) return search.code != IkErrc::joint_limit;
  return form.code != IkErrc::no_convergence;
}

/// What is found beside a form whose branches are no proof and have been weighed by `choice`. Kept
/// out of line: its list of branches would be on the stack of every answer.
[[gnu::noinline]] Result<IkSolution, IkFailure> search_beside(const IkSolver& ik,
                                                              const IkGoal& goal,
                                                              BranchChoice& choice,
                                                              const Branches& branches) noexcept {
  const IkOptions& options = ik.options();
  if (ik.general_six()) {
    Branches all;
    ClosedForm::branches(*ik.general_six(),
                         {goal.X_WT, goal.seed.data(), options.pos_tol, options.rot_tol}, all);
    if (const auto solution = choice.nearest(all)) return *solution;
  }
  auto found = search_numeric(ik.chain(), options, ik.length(), goal);
  if (found) return found;
  const IkFailure failure = choice.failure(branches);
  return is_told(failure, found.error()) ? fail(failure) : std::move(found);
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
  return search_beside(ik, goal, choice, branches);
}

/// True where a form of seven axes may have missed an answer: it came near to the limits, between
/// two samples, or took one configuration for a whole family, where the tool can rest while the
/// last joint does not move: at singularities of the other six, such as a straight shoulder.
bool is_doubtful(const IkSolver& ik, const Branches& branches, const IkFailure& failure) noexcept {
  if (!branches.complete) return true;
  if (failure.code != IkErrc::joint_limit) return false;
  if (failure.amount < kNearLimits) return true;
  const Jacobian six = fk_jacobian(ik.links(), {branches.q[0], 7}).J_W.leftCols(6);
  return smallest_singular_value(six) < kSingular;
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
  const IkFailure failure = choice.failure(branches);
  if (!is_doubtful(ik, branches, failure)) return fail(failure);
  return search_beside(ik, goal, choice, branches);
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
  if (!six_ || !six_->is_exact()) general_ = GeneralSix::recognise(chain_);
}

IkSolver IkSolver::with(IkOptions options) const {
  if (options.closed_form != options_.closed_form || options.task != options_.task) {
    return IkSolver(arm_, std::move(options));
  }
  IkSolver out(*this);
  out.options_ = std::move(options);
  return out;
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
