#include "mjarm/kinematics/ik_all.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mjarm/core/units.hpp"
#include "mjarm/kinematics/branch_choice_internal.hpp"

namespace mjarm {
namespace {

using detail::IkGoal;
using detail::nearness;

double distance(const JointVec& a, const JointVec& b) { return (a - b).cwiseAbs().maxCoeff(); }

/// Collects the distinct ones of what is given to it.
class Answers {
 public:
  explicit Answers(double same) : same_(same) { list_.reserve(16); }

  [[nodiscard]] bool knows(const JointVec& q) const {
    return std::any_of(list_.begin(), list_.end(),
                       [&](const IkSolution& other) { return distance(other.q, q) < same_; });
  }
  void add(const IkSolution& solution) {
    if (!knows(solution.q)) list_.push_back(solution);
  }
  [[nodiscard]] std::vector<IkSolution>& list() { return list_; }

 private:
  double same_;
  std::vector<IkSolution> list_;
};

/// False where the form may have missed one.
template <class Form>
bool add_branches(const Form& form, const IkSolver& ik, const IkGoal& goal, Answers& answers) {
  const IkOptions& options = ik.options();
  detail::Branches branches;
  detail::BranchQuery query{goal.X_WT, goal.seed.data(), options.pos_tol, options.rot_tol};
  query.all = true;
  detail::ClosedForm::branches(form, query, branches);
  detail::BranchChoice(ik, goal).each(branches,
                                      [&](const IkSolution& solution) { answers.add(solution); });
  return branches.complete;
}

void add_samples(const IkSolver& ik, const IkGoal& goal, int starts, Answers& answers) {
  const IkOptions& options = ik.options();
  const detail::DescentOptions descent_options = detail::descent_options(options, ik.length());
  Rng rng(options.seed, 1);  // another stream than that of solve()
  for (int start = 1; start <= starts; ++start) {
    const JointVec q_start = detail::random_start(ik.chain(), goal.seed, rng);
    const auto descent = detail::descend(ik.chain(), goal.X_WT, q_start, descent_options);
    if (!descent.converged) continue;
    const JointVec q = unwind(ik.chain(), descent.q, goal.seed);
    if (answers.knows(q) || distance(q, goal.seed) > options.max_step) continue;
    if (options.valid && !options.valid(as_span(q))) continue;
    answers.add({q, descent.pos_err, descent.rot_err, descent.iterations, start});
  }
}

/// Appends `solution` in every winding within the limits, `max` in all.
void expand(const Chain& chain, const IkSolution& solution, std::size_t max,
            std::vector<IkSolution>& out) {
  std::vector<JointVec> qs{solution.q};
  for (int i = 0; i < chain.dof; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!chain.full_turn[k] || !std::isfinite(chain.upper[k] - chain.lower[k])) continue;
    const double q = solution.q[i];
    const double first = q - kFullTurn * std::floor((q - chain.lower[k]) / kFullTurn);
    const std::size_t count = qs.size();
    for (double other = first; other <= chain.upper[k] && qs.size() < max; other += kFullTurn) {
      if (std::abs(other - q) < 1) continue;  // the winding that is there already
      for (std::size_t j = 0; j < count && qs.size() < max; ++j) {
        qs.push_back(qs[j]);
        qs.back()[i] = other;
      }
    }
  }
  for (const JointVec& q : qs) {
    out.push_back(solution);
    out.back().q = q;
  }
}

void sort_by_distance(std::vector<IkSolution>& answers, const JointVec& q_seed) {
  std::sort(answers.begin(), answers.end(), [&](const IkSolution& a, const IkSolution& b) {
    const int dof = static_cast<int>(q_seed.size());
    const auto near_a = nearness(a.q.data(), q_seed.data(), dof);
    const auto near_b = nearness(b.q.data(), q_seed.data(), dof);
    if (near_a < near_b || near_b < near_a) return near_a < near_b;
    return std::lexicographical_compare(a.q.begin(), a.q.end(), b.q.begin(), b.q.end());
  });
}

}  // namespace

Result<std::vector<IkSolution>, IkFailure> solve_all(const IkSolver& ik, const Pose& X_WT,
                                                     std::span<const double> q_seed,
                                                     const IkAllOptions& options) {
  IkGoal goal;
  const bool sane = detail::check_goal(ik.chain(), ik.options(), X_WT, q_seed, goal);
  Answers answers(options.same);
  bool known = false;  // every branch, or what random starts find of them
  if (sane && ik.six_axis()) known = add_branches(*ik.six_axis(), ik, goal, answers);
  if (sane && ik.general_six()) {
    known = true;
    if (!add_branches(*ik.general_six(), ik, goal, answers)) {
      add_samples(ik, goal, options.starts, answers);
    }
  }
  if (!known || answers.list().empty()) {
    const auto first = ik.solve(X_WT, q_seed);
    if (!first && answers.list().empty()) return fail(first.error());
    if (first) answers.add(*first);
    if (ik.seven_axis()) {
      add_branches(*ik.seven_axis(), ik, goal, answers);
    } else if (!ik.six_axis()) {
      add_samples(ik, goal, options.starts, answers);
    }
  }
  std::vector<IkSolution> list = std::move(answers.list());
  const auto max = static_cast<std::size_t>(std::max(options.max, 1));
  if (options.windings) {
    std::vector<IkSolution> wound;
    for (const IkSolution& solution : list) expand(ik.chain(), solution, max, wound);
    std::erase_if(wound, [&](const IkSolution& solution) {
      return distance(solution.q, goal.seed) > ik.options().max_step;
    });
    list = std::move(wound);
  }
  sort_by_distance(list, goal.seed);
  if (list.size() > max) list.resize(max);
  return list;
}

}  // namespace mjarm
