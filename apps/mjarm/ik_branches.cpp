#include "apps/mjarm/ik_branches.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mjarm/core/rng.hpp"

namespace mjarm::app {
namespace {

bool are_same(const Arm& arm, const JointVec& a, const JointVec& b, double tolerance) {
  for (int i = 0; i < arm.dof(); ++i) {
    double difference = a[i] - b[i];
    if (arm.joints[static_cast<std::size_t>(i)].type == JointType::hinge) {
      difference = std::remainder(difference, 2 * std::numbers::pi);
    }
    if (std::abs(difference) > tolerance) return false;
  }
  return true;
}

JointVec random_start(const Arm& arm, Rng& rng) {
  JointVec q(arm.dof());
  for (int i = 0; i < arm.dof(); ++i) {
    // A joint without stops starts within one turn.
    const double lower = std::max(arm.limits.lower[i], -std::numbers::pi);
    const double upper = std::min(arm.limits.upper[i], std::numbers::pi);
    q[i] = lower < upper ? rng.uniform(lower, upper)
                         : rng.uniform(arm.limits.lower[i], arm.limits.upper[i]);
  }
  return q;
}

}  // namespace

std::vector<JointVec> find_branches(const IkSolver& solver, const Pose& X_WT, const JointVec& first,
                                    const BranchOptions& options) {
  const Arm& arm = solver.arm();
  IkOptions one_start = solver.options();
  one_start.restarts = 0;
  const IkSolver once(arm, one_start);
  Rng rng(options.rng_seed);
  std::vector<JointVec> branches = {first};
  for (int i = 0; i < options.starts && static_cast<int>(branches.size()) < options.most; ++i) {
    const JointVec start = random_start(arm, rng);
    const Result<IkSolution, IkFailure> found = once.solve(X_WT, view(start));
    if (!found) continue;
    const bool known = std::any_of(branches.begin(), branches.end(), [&](const JointVec& branch) {
      return are_same(arm, branch, found->q, options.same);
    });
    if (!known) branches.push_back(found->q);
  }
  return branches;
}

}  // namespace mjarm::app
