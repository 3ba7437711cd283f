#include "mjarm/kinematics/ik.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "mjarm/kinematics/ik_search_internal.hpp"

namespace mjarm {
namespace {

using detail::Descent;
using detail::DescentOptions;
using detail::IkGoal;

/// One solve: the goal, what has been met so far and what is counted.
class Search {
 public:
  Search(const Chain& chain, const IkOptions& options, double length, const IkGoal& goal) noexcept
      : chain_(chain),
        options_(options),
        descent_(detail::descent_options(options, length)),
        goal_(goal),
        rng_(options.rng_seed) {}

  /// The seed, then random starts, until an answer is found that `valid` accepts.
  std::optional<IkSolution> run() noexcept {
    for (int start = 0; start <= options_.restarts; ++start) {
      if (try_start(start)) return best_;
    }
    return std::nullopt;
  }

  /// One descent from the seed, for the best attempt of a pose that is known to be out of reach.
  IkSolution nearest_from_seed() noexcept {
    try_start(0);
    return best_;
  }

  /// What to say when run() found nothing.
  IkFailure failure() noexcept {
    IkFailure out;
    out.best = best_;
    if (refused_) {
      out.code = IkErrc::collision;
    } else {
      find_beyond_limits(out);
    }
    return out;
  }

 private:
  bool try_start(int start) noexcept {
    const JointVec q_start =
        start == 0 ? goal_.seed : detail::random_start(chain_, goal_.seed, rng_);
    const Descent descent = detail::descend(chain_, goal_.X_WT, q_start, descent_);
    iterations_ += descent.iterations;
    IkSolution met{detail::unwind(chain_, descent.q, goal_.seed), descent.pos_err, descent.rot_err,
                   iterations_, start};
    const bool accepted = descent.converged && is_valid(met.q);
    // An answer that was refused beats any configuration that is none.
    const bool closer = descent.converged ? !refused_ : !refused_ && descent.error < best_error_;
    if (accepted || closer || start == 0) {
      best_ = met;
      best_error_ = descent.error;
    }
    if (descent.converged && !accepted) refused_ = true;
    best_.iterations = iterations_;
    best_.restarts = start;
    return accepted;
  }

  bool is_valid(const JointVec& q) const noexcept {
    return !options_.valid || options_.valid(view(q));
  }

  /// Searches without limits; where that reaches the pose, names the joint that is farthest beyond
  /// its limit in the answer that breaks its limits least.
  void find_beyond_limits(IkFailure& out) noexcept {
    constexpr int kStarts = 12;
    DescentOptions free = descent_;
    free.limits = false;
    for (int start = 0; start < kStarts; ++start) {
      const JointVec q_start =
          start == 0 ? goal_.seed : detail::random_start(chain_, goal_.seed, rng_);
      const Descent descent = detail::descend(chain_, goal_.X_WT, q_start, free);
      if (!descent.converged) continue;
      const auto [joint, amount] = worst_violation(descent.q);
      if (amount <= 0 || (out.joint >= 0 && amount >= out.amount)) continue;
      out.code = IkErrc::joint_limit;
      out.joint = joint;
      out.amount = amount;
    }
  }

  std::pair<int, double> worst_violation(const JointVec& q) const noexcept {
    std::pair<int, double> worst{-1, 0.0};
    for (int i = 0; i < chain_.dof; ++i) {
      if (chain_.full_turn[i]) continue;
      double value = q[i];
      if (!chain_.slide[i]) {
        const double middle = 0.5 * (chain_.lower[i] + chain_.upper[i]);
        value = middle + std::remainder(value - middle, 2 * std::numbers::pi);
      }
      const double beyond = std::max(chain_.lower[i] - value, value - chain_.upper[i]);
      if (beyond > worst.second) worst = {i, beyond};
    }
    return worst;
  }

  const Chain& chain_;
  const IkOptions& options_;
  const DescentOptions descent_;
  const IkGoal& goal_;
  Rng rng_;
  IkSolution best_;
  double best_error_ = 0;
  int iterations_ = 0;
  bool refused_ = false;
};

}  // namespace

IkSolver::IkSolver(const Arm& arm, IkOptions options)
    : arm_(arm),
      options_(std::move(options)),
      chain_(arm),
      reach_(arm),
      length_(detail::characteristic_length(chain_)) {}

Result<IkSolution, IkFailure> IkSolver::solve(const Pose& X_WT,
                                              std::span<const double> q_seed) const noexcept {
  IkGoal goal;
  if (!detail::check_goal(chain_, options_, X_WT, q_seed, goal)) {
    IkFailure failure;
    failure.code = IkErrc::bad_input;
    failure.best.q = JointVec::Zero(chain_.dof);
    return fail(failure);
  }
  Search search(chain_, options_, length_, goal);
  // The proofs of reach are about a tool whose orientation is given.
  const auto breach = options_.task == IkTask::pose ? reach_.check(goal.X_WT) : std::nullopt;
  if (breach) {
    IkFailure failure;
    failure.code =
        breach->shape == ReachShape::outer_sphere ? IkErrc::out_of_reach : IkErrc::inner_void;
    failure.best = search.nearest_from_seed();
    failure.amount = breach->amount;
    failure.bound = breach->bound;
    failure.shape = breach->shape;
    return fail(failure);
  }
  if (const std::optional<IkSolution> solution = search.run()) return *solution;
  return fail(search.failure());
}

}  // namespace mjarm
