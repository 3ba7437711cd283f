#include <algorithm>
#include <cmath>

#include "mjarm/core/finite.hpp"
#include "mjarm/planning/search_internal.hpp"

namespace mjarm::detail {
namespace {

tl::unexpected<PlanFailure> no_path(PlanErrc reason) {
  PlanFailure failure;
  failure.reason = reason;
  return tl::unexpected(failure);
}

tl::unexpected<PlanFailure> outside(PlanErrc reason, std::span<const double> q, int joint) {
  PlanFailure failure;
  failure.reason = reason;
  failure.joint = joint;
  failure.value = q[static_cast<std::size_t>(joint)];
  return tl::unexpected(failure);
}

tl::unexpected<PlanFailure> start_hit(const FastChecker& checker, std::span<const double> q) {
  PlanFailure failure;
  failure.reason = PlanErrc::start_hit;
  failure.pair = checker.clearance(q);
  return tl::unexpected(failure);
}

/// Of the goals within the limits, the one that overlaps least.
tl::unexpected<PlanFailure> all_hit(const FastChecker& checker, std::span<const double> goals) {
  PlanFailure failure;
  failure.reason = PlanErrc::goals_hit;
  failure.pair.distance = -std::numeric_limits<double>::infinity();
  const Arm& arm = checker.robot().arm();
  const auto dof = static_cast<std::size_t>(arm.dof());
  for (std::size_t g = 0; g < goals.size(); g += dof) {
    const std::span<const double> goal = goals.subspan(g, dof);
    if (outside_joint(arm, goal) >= 0) continue;
    const SphereClearance pair = checker.clearance(goal);
    if (pair.distance > failure.pair.distance) failure.pair = pair;
  }
  return tl::unexpected(failure);
}

tl::unexpected<PlanFailure> tilted(PlanErrc reason, const TiltLimit& limit, const Arm& arm,
                                   std::span<const double> q) {
  PlanFailure failure;
  failure.reason = reason;
  failure.value = tilt(limit, arm, q);
  failure.limit = limit.max;
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

Result<SearchProblem, PlanFailure> look_at_problem(const FastChecker& checker,
                                                   std::span<const double> start,
                                                   std::span<const double> goals,
                                                   const PlanOptions& options) {
  const Arm& arm = checker.robot().arm();
  const auto dof = static_cast<std::size_t>(arm.dof());
  if (start.size() != dof || goals.empty() || goals.size() % dof != 0 || !all_finite(start) ||
      !all_finite(goals)) {
    return no_path(PlanErrc::bad_input);
  }
  if (options.tilt && !is_sound(*options.tilt)) return no_path(PlanErrc::bad_tilt);
  if (checker.fixed_overlap()) {
    PlanFailure failure;
    failure.reason = PlanErrc::base_hit;
    failure.pair = {0, checker.fixed_overlap()->link, checker.fixed_overlap()->obstacle, -1};
    return tl::unexpected(failure);
  }
  if (const int k = outside_joint(arm, start); k >= 0) {
    return outside(PlanErrc::start_outside, start, k);
  }
  if (!checker.is_free(start)) return start_hit(checker, start);
  SearchProblem out{checker, start, {}, {}, TiltKeeper::make(options.tilt, arm)};
  if (out.tilt && !out.tilt->keeps(start)) {
    return tilted(PlanErrc::start_tilted, *options.tilt, arm, start);
  }
  bool any_inside = false;
  int first_free = -1;
  for (std::size_t g = 0; g * dof < goals.size(); ++g) {
    const std::span<const double> goal = goals.subspan(g * dof, dof);
    if (outside_joint(arm, goal) >= 0) continue;
    any_inside = true;
    if (!checker.is_free(goal)) continue;
    if (first_free < 0) first_free = static_cast<int>(g);
    if (!out.tilt || out.tilt->keeps(goal)) out.goal_index.push_back(static_cast<int>(g));
  }
  if (!any_inside) {
    const std::span<const double> goal = goals.first(dof);
    return outside(PlanErrc::goals_outside, goal, outside_joint(arm, goal));
  }
  const auto goal_of = [&](int g) { return goals.subspan(static_cast<std::size_t>(g) * dof, dof); };
  if (first_free < 0) return all_hit(checker, goals);
  if (out.goal_index.empty()) {
    return tilted(PlanErrc::goals_tilted, *options.tilt, arm, goal_of(first_free));
  }
  std::stable_sort(out.goal_index.begin(), out.goal_index.end(), [&](int a, int b) {
    return distance(start, goal_of(a)) < distance(start, goal_of(b));
  });
  for (const int g : out.goal_index) out.goals.push_back(goal_of(g));
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
