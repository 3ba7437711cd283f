#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "mjarm/kinematics/lane_search_internal.hpp"
#include "mjarm/kinematics/numeric_search_internal.hpp"

namespace mjarm::detail {
namespace {

/// One search: the goal, what has been met so far and what is counted.
class Search {
 public:
  Search(const Chain& chain, const IkOptions& options, double length, const IkGoal& goal) noexcept
      : chain_(chain),
        options_(options),
        descent_(descent_options(options, length)),
        goal_(goal),
        rng_(options.seed) {}

  /// The seed and random starts, until an answer is found that `valid` accepts; where there was
  /// none at all, in another way.
  std::optional<IkSolution> run() noexcept {
    LaneSearch lanes(chain_, goal_.X_WT, descent_, goal_.seed, options_.restarts + 1, rng_);
    while (const auto end = lanes.next()) {
      iterations_ = lanes.steps();
      if (take(end->descent, end->start)) return best_;
    }
    if (refused_) return std::nullopt;
    if (const auto found = run_from_beyond()) return found;
    return go_on_from_best();
  }

  /// One descent from the seed, for the best attempt of a pose that is known to be out of reach.
  IkSolution nearest_from_seed() noexcept {
    const Descent descent = descend(chain_, goal_.X_WT, goal_.seed, descent_);
    iterations_ = descent.iterations;
    take(descent, 0);
    return best_;
  }

  /// What to say when run() found nothing.
  IkFailure failure() noexcept {
    IkFailure out;
    if (!refused_) measure_best();
    out.best = best_;
    out.best.restarts = options_.restarts;
    if (refused_) {
      out.code = too_far_ ? IkErrc::too_far : IkErrc::collision;
      if (too_far_) out.amount = largest_step(best_.q, &out.joint) - options_.max_step;
    } else {
      find_beyond_limits(out);
    }
    return out;
  }

 private:
  /// In corners of the limits the descents of run() lose their way. Here they are done without
  /// limits, which leads to all branches quickly; each is then put within the limits and descends
  /// again, joints that come to a limit giving over to the others.
  std::optional<IkSolution> run_from_beyond() noexcept {
    if (!has_stops()) return std::nullopt;
    const bool redundant = chain_.dof > 6 || options_.task != IkTask::pose;
    // Without joints to spare the way within the limits is short or there is none.
    const double max_beyond = redundant ? 1.0 : 0.1;  // [rad or m]
    const int starts = (redundant ? 12 : 3) * std::min(options_.restarts, 100);
    DescentOptions free = descent_;
    free.limits = false;
    DescentOptions careful = descent_;
    careful.share = true;
    Rng rng(options_.seed, 2);  // another stream: what is told of a failure does not change
    LaneSearch lanes(chain_, goal_.X_WT, free, goal_.seed, starts, rng, random_start_at_stops);
    while (const auto end = lanes.next()) {
      if (!end->descent.converged) continue;
      JointVec q = put_between_stops(end->descent.q);
      if (worst_violation(q).second > max_beyond) continue;
      for (int i = 0; i < chain_.dof; ++i) {
        if (!chain_.full_turn[i]) q[i] = std::clamp(q[i], chain_.lower[i], chain_.upper[i]);
      }
      const Descent descent = descend(chain_, goal_.X_WT, q, careful);
      if (!descent.converged) continue;
      iterations_ += descent.iterations;
      if (take(descent, options_.restarts + end->start)) return best_;
    }
    return std::nullopt;
  }

  /// Where several directions are lost at once, or in a corner of the limits, steps overshoot near
  /// the goal and descents are given up: from the nearest one on, only steps that get nearer are
  /// taken, shorter ones where need be (Levenberg and Marquardt).
  std::optional<IkSolution> go_on_from_best() noexcept {
    constexpr double kClose = 1e-4;  // [rad^2]
    constexpr double kStuck = 1;     // [rad^2] damping at which steps are as good as none
    constexpr int kSteps = 2000;
    DescentOptions one_step = descent_;
    one_step.max_iterations = 1;
    one_step.share = true;
    for (int i = 0; i < kSteps && best_error_ < kClose && one_step.damping < kStuck; ++i) {
      const Descent descent = descend(chain_, goal_.X_WT, best_.q, one_step);
      iterations_ += descent.iterations;
      one_step.damping *= descent.error < best_error_ ? 0.3 : 4.0;
      if (take(descent, options_.restarts)) return best_;
    }
    return std::nullopt;
  }

  /// Weighs the end of a descent; true where it is the answer.
  bool take(const Descent& descent, int start) noexcept {
    const IkSolution met{unwind(chain_, descent.q, goal_.seed), descent.pos_err, descent.rot_err,
                         iterations_, start};
    const bool near = descent.converged && largest_step(met.q, nullptr) <= options_.max_step;
    const bool accepted = near && is_valid(met.q);
    const bool first_valid_step = near && too_far_;  // a refusal by the predicate says more
    // An answer that was refused beats any configuration that is none.
    const bool closer = descent.converged ? !refused_ : !refused_ && descent.error < best_error_;
    if (accepted || closer || first_valid_step || best_.q.size() == 0) {
      best_ = met;
      best_error_ = descent.error;
    }
    if (descent.converged && !accepted) {
      too_far_ = !near && (too_far_ || !refused_);
      refused_ = true;
    }
    best_.iterations = iterations_;
    return accepted;
  }

  /// Errors of the best attempt, which descents that were given up leave out.
  void measure_best() noexcept {
    DescentOptions still = descent_;
    still.max_iterations = 0;
    const Descent descent = descend(chain_, goal_.X_WT, best_.q, still);
    best_.pos_err = descent.pos_err;
    best_.rot_err = descent.rot_err;
  }

  double largest_step(const JointVec& q, int* joint) const noexcept {
    Eigen::Index i = 0;
    const double step = (q - goal_.seed).cwiseAbs().maxCoeff(&i);
    if (joint != nullptr) *joint = static_cast<int>(i);
    return step;
  }

  bool is_valid(const JointVec& q) const noexcept {
    return !options_.valid || options_.valid(as_span(q));
  }

  /// Searches without limits; where that reaches the pose, names the joint that is farthest beyond
  /// its limit in the answer that breaks its limits least.
  void find_beyond_limits(IkFailure& out) noexcept {
    constexpr int kStarts = 16;
    DescentOptions free = descent_;
    free.limits = false;
    LaneSearch lanes(chain_, goal_.X_WT, free, goal_.seed, kStarts, rng_);
    while (const auto end = lanes.next()) {
      const Descent& descent = end->descent;
      if (!descent.converged) continue;
      const auto [joint, amount] = worst_violation(descent.q);
      if (amount <= 0 || (out.joint >= 0 && amount >= out.amount)) continue;
      out.code = IkErrc::joint_limit;
      out.joint = joint;
      out.amount = amount;
    }
  }

  bool has_stops() const noexcept {
    bool any = false;
    for (int i = 0; i < chain_.dof; ++i) {
      any = any || (!chain_.full_turn[i] &&
                    (std::isfinite(chain_.lower[i]) || std::isfinite(chain_.upper[i])));
    }
    return any;
  }

  /// Hinges with stops in the winding that is nearest to the middle between them.
  JointVec put_between_stops(JointVec q) const noexcept {
    for (int i = 0; i < chain_.dof; ++i) {
      if (chain_.full_turn[i] || chain_.slide[i]) continue;
      const double middle = 0.5 * (chain_.lower[i] + chain_.upper[i]);
      q[i] = middle + std::remainder(q[i] - middle, 2 * std::numbers::pi);
    }
    return q;
  }

  /// The joint that is farthest beyond its limit, and by how much [rad or m].
  std::pair<int, double> worst_violation(const JointVec& q) const noexcept {
    const JointVec between = put_between_stops(q);
    std::pair<int, double> worst{-1, 0.0};
    for (int i = 0; i < chain_.dof; ++i) {
      if (chain_.full_turn[i]) continue;
      const double beyond = std::max(chain_.lower[i] - between[i], between[i] - chain_.upper[i]);
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
  bool refused_ = false;  // some answer was refused, by max_step alone where too_far_
  bool too_far_ = false;
};

}  // namespace

Result<IkSolution, IkFailure> search_numeric(const Chain& chain, const IkOptions& options,
                                             double length, const IkGoal& goal) noexcept {
  Search search(chain, options, length, goal);
  if (const std::optional<IkSolution> solution = search.run()) return *solution;
  return fail(search.failure());
}

IkSolution nearest_from_seed(const Chain& chain, const IkOptions& options, double length,
                             const IkGoal& goal) noexcept {
  return Search(chain, options, length, goal).nearest_from_seed();
}

}  // namespace mjarm::detail
