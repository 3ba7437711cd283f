#include "mjarm/kinematics/ik_all.hpp"

#include <algorithm>
#include <utility>

#include "mjarm/kinematics/ik_search_internal.hpp"

namespace mjarm {
namespace {

double distance(const JointVec& a, const JointVec& b) { return (a - b).cwiseAbs().maxCoeff(); }

void sort_by_distance(std::vector<IkSolution>& answers, const JointVec& q_seed) {
  std::sort(answers.begin(), answers.end(), [&](const IkSolution& a, const IkSolution& b) {
    const double da = distance(a.q, q_seed);
    const double db = distance(b.q, q_seed);
    if (da != db) return da < db;
    return std::lexicographical_compare(a.q.begin(), a.q.end(), b.q.begin(), b.q.end());
  });
}

}  // namespace

Result<std::vector<IkSolution>, IkFailure> solve_all(const IkSolver& ik, const Pose& X_WT,
                                                     std::span<const double> q_seed,
                                                     const IkAllOptions& options) {
  const auto first = ik.solve(X_WT, q_seed);
  if (!first) return fail(first.error());
  const Chain chain(ik.arm());
  detail::IkGoal goal;
  if (!detail::check_goal(chain, ik.options(), X_WT, q_seed, goal)) return fail(IkFailure{});
  const auto& valid = ik.options().valid;
  const detail::DescentOptions descent_options =
      detail::descent_options(ik.options(), detail::characteristic_length(chain));
  std::vector<IkSolution> answers{*first};
  Rng rng(ik.options().rng_seed, 1);  // another stream than that of solve()
  for (int start = 1; start <= options.starts; ++start) {
    const JointVec q_start = detail::random_start(chain, goal.seed, rng);
    const auto descent = detail::descend(chain, goal.X_WT, q_start, descent_options);
    if (!descent.converged) continue;
    const JointVec q = detail::unwind(chain, descent.q, goal.seed);
    const bool known = std::any_of(answers.begin(), answers.end(), [&](const IkSolution& other) {
      return distance(other.q, q) < options.same;
    });
    if (known || (valid && !valid(view(q)))) continue;
    answers.push_back({q, descent.pos_err, descent.rot_err, descent.iterations, start});
  }
  sort_by_distance(answers, goal.seed);
  return answers;
}

}  // namespace mjarm
