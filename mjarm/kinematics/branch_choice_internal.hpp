#pragma once

#include <limits>
#include <optional>

#include "mjarm/kinematics/branches_internal.hpp"
#include "mjarm/kinematics/ik_search_internal.hpp"

namespace mjarm::detail {

/// How the answers near a goal are weighed: the largest joint distance first, then the sum.
struct Nearness {
  double largest = 0;  ///< [rad or m]
  double sum = 0;
  [[nodiscard]] bool operator<(const Nearness& other) const noexcept {
    return largest < other.largest || (largest == other.largest && sum < other.sum);
  }
};

/// The distance of `q` from `q_near`, both shape (dof,).
[[nodiscard]] Nearness nearness(const double* q, const double* q_near, int dof) noexcept;

/// Turns the branches of a closed form into an answer: each is wound to the seed and held against
/// the limits, then, nearest first, checked by forward kinematics, polished where that shows more
/// than 1e-10 (m or rad), and shown to the predicate. Never allocates.
class BranchChoice {
 public:
  BranchChoice(const IkSolver& ik, const IkGoal& goal) noexcept;

  /// The nearest branch that holds; none where failure() has the reason.
  std::optional<IkSolution> nearest(const Branches& branches) noexcept;

  /// True where the predicate or the bound on the step has refused an answer.
  [[nodiscard]] bool has_refused() const noexcept { return refused_ || too_far_; }

  /// Every branch that holds, in its winding nearest to the seed: `take(solution)` for each.
  template <class Take>
  void each(const Branches& branches, Take take) noexcept {
    for (int i = 0; i < branches.count; ++i) {
      const auto solution = confirm(branches.q[i]);
      if (solution && is_near(*solution) && is_accepted(solution->q)) take(*solution);
    }
  }

  /// Why nearest() had none, with the closest attempt.
  [[nodiscard]] IkFailure failure(const Branches& branches) noexcept;

 private:
  static constexpr double kNoBound = std::numeric_limits<double>::infinity();

  /// A branch in the winding nearest to the seed and how far it is beyond the limits.
  struct Placed {
    double q[Branches::kMaxJoints];
    double beyond = 0;  // [rad] of the joint that is farthest beyond its limit, 0 where none is
    int joint = -1;
    Nearness near;      // to the seed
    bool whole = true;  // false: given up, `near` is a lower bound, the rest is not worked out
  };
  /// Gives up at a joint farther from the seed than `bound` [rad or m].
  [[nodiscard]] Placed place(const double* row, double bound = kNoBound) const noexcept;
  [[nodiscard]] std::optional<IkSolution> confirm(const double* row) const noexcept;
  [[nodiscard]] IkSolution measure(const double* q) const noexcept;
  [[nodiscard]] bool is_near(const IkSolution& solution) const noexcept {
    return nearness(solution.q.data(), goal_.seed.data(), chain_.dof).largest <= options_.max_step;
  }
  [[nodiscard]] bool is_accepted(const JointVec& q) const noexcept {
    return !options_.valid || options_.valid(as_span(q));
  }

  const IkSolver& ik_;
  const Chain& chain_;
  const IkOptions& options_;
  const IkGoal& goal_;
  double beyond_;                      // [rad] so little beyond a limit, a branch may still hold
  std::optional<IkSolution> refused_;  // the nearest answer that the predicate refused
  std::optional<IkSolution> too_far_;  // the nearest answer beyond max_step
};

}  // namespace mjarm::detail
