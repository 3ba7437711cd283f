#include <algorithm>
#include <cmath>

#include "mjarm/core/finite.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/planning/search_internal.hpp"

namespace mjarm::detail {
namespace {

tl::unexpected<PlanFailure> no_path(PlanErrc reason) {
  PlanFailure failure;
  failure.code = reason;
  return tl::unexpected(failure);
}

tl::unexpected<PlanFailure> outside(PlanErrc reason, std::span<const double> q, int joint) {
  PlanFailure failure;
  failure.code = reason;
  failure.joint = joint;
  failure.value = q[static_cast<std::size_t>(joint)];
  return tl::unexpected(failure);
}

tl::unexpected<PlanFailure> start_hit(const FastChecker& checker, std::span<const double> q) {
  PlanFailure failure;
  failure.code = PlanErrc::start_hit;
  failure.pair = checker.clearance(q);
  return tl::unexpected(failure);
}

/// Of the goals within the limits, the one that overlaps least.
tl::unexpected<PlanFailure> all_hit(const FastChecker& checker, std::span<const JointVec> goals) {
  PlanFailure failure;
  failure.code = PlanErrc::goals_hit;
  failure.pair.distance = -std::numeric_limits<double>::infinity();
  for (const JointVec& goal : goals) {
    if (outside_joint(checker.robot().arm(), as_span(goal)) >= 0) continue;
    const SphereClearance pair = checker.clearance(as_span(goal));
    if (pair.distance > failure.pair.distance) failure.pair = pair;
  }
  return tl::unexpected(failure);
}

/// Which of both is not kept at `q`.
tl::unexpected<PlanFailure> not_kept(PlanErrc tilted, PlanErrc off, const PlanOptions& options,
                                     const Arm& arm, std::span<const double> q) {
  PlanFailure failure;
  if (options.within) failure.room = room_in(*options.within, fk(arm, q));
  failure.code = off;
  if (options.tilt) failure.value = tilt(*options.tilt, arm, q);
  if (options.tilt && (!options.within || failure.value > options.tilt->max)) {
    failure.code = tilted;
    failure.limit = options.tilt->max;
  }
  return tl::unexpected(failure);
}

}  // namespace

int outside_joint(const Arm& arm, std::span<const double> q) {
  constexpr double kSlack = 1e-4;  // [rad or m]; rounded digits of a file
  for (int k = 0; k < arm.dof(); ++k) {
    const double value = q[static_cast<std::size_t>(k)];
    if (!(value >= arm.limits.lower[k] - kSlack && value <= arm.limits.upper[k] + kSlack)) return k;
  }
  return -1;
}

Result<SearchProblem, PlanFailure> validate_problem(const FastChecker& checker,
                                                    std::span<const double> start,
                                                    std::span<const JointVec> goals,
                                                    const PlanOptions& options) {
  const Arm& arm = checker.robot().arm();
  const auto fits = [&arm](std::span<const double> q) {
    return q.size() == static_cast<std::size_t>(arm.dof()) && all_finite(q);
  };
  const auto goal_fits = [&fits](const JointVec& goal) { return fits(as_span(goal)); };
  if (!fits(start) || goals.empty() || !std::ranges::all_of(goals, goal_fits)) {
    return no_path(PlanErrc::bad_input);
  }
  if (options.tilt && !is_sound(*options.tilt)) return no_path(PlanErrc::bad_tilt);
  if (options.within && !can_be_kept(*options.within)) return no_path(PlanErrc::bad_region);
  if (checker.fixed_overlap()) {
    PlanFailure failure;
    failure.code = PlanErrc::base_hit;
    failure.pair = {0, checker.fixed_overlap()->link, checker.fixed_overlap()->obstacle, -1};
    return tl::unexpected(failure);
  }
  if (const int k = outside_joint(arm, start); k >= 0) {
    return outside(PlanErrc::start_outside, start, k);
  }
  if (!checker.is_free(start)) return start_hit(checker, start);
  SearchProblem out{checker, start, {}, {}, PathKeeper::create(options, arm)};
  if (out.keeper && !out.keeper->keeps(start)) {
    return not_kept(PlanErrc::start_tilted, PlanErrc::start_off, options, arm, start);
  }
  const auto goal_of = [&](int g) { return as_span(goals[static_cast<std::size_t>(g)]); };
  bool any_inside = false;
  int first_free = -1;
  for (int g = 0; g < static_cast<int>(goals.size()); ++g) {
    if (outside_joint(arm, goal_of(g)) >= 0) continue;
    any_inside = true;
    if (!checker.is_free(goal_of(g))) continue;
    if (first_free < 0) first_free = g;
    if (!out.keeper || out.keeper->keeps(goal_of(g))) out.goal_index.push_back(g);
  }
  if (!any_inside) {
    return outside(PlanErrc::goals_outside, goal_of(0), outside_joint(arm, goal_of(0)));
  }
  if (first_free < 0) return all_hit(checker, goals);
  if (out.goal_index.empty()) {
    return not_kept(PlanErrc::goals_tilted, PlanErrc::goals_off, options, arm, goal_of(first_free));
  }
  std::ranges::stable_sort(out.goal_index, {}, [&](int g) { return distance(start, goal_of(g)); });
  for (const int g : out.goal_index) out.goals.push_back(goal_of(g));
  out.deadline = Deadline(options.stop);
  return out;
}

double least_cost_through(const SearchProblem& problem, std::span<const double> q) {
  double least = std::numeric_limits<double>::infinity();
  if (!std::isfinite(problem.max_cost)) return 0;
  for (const std::span<const double> goal : problem.goals) {
    least = std::min(least, distance(q, goal));
  }
  return distance(problem.start, q) + least;
}

}  // namespace mjarm::detail
