#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/bench/plan_near.hpp"
#include "apps/bench/robots.hpp"
#include "mjarm/collision/first_contact.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm::app {
namespace {

constexpr double kContactSpacing = 0.001;  // [rad or m, L2]
constexpr double kJointTol = 1e-4;         // [rad or m] at both ends and at limits

bool is_close(const JointVec& a, const JointVec& b) {
  return (a - b).cwiseAbs().maxCoeff() <= kJointTol;
}

bool is_row(const Arm& arm, const std::vector<double>& q) {
  return q.size() == arm.joints.size() &&
         std::ranges::all_of(q, [](double value) { return std::isfinite(value); });
}

Result<bool> meets_goal(const NearSet& set, const NearProblem& problem, const JointVec& q) {
  if (!problem.X_WT) return is_close(q, problem.goal);
  // Peers may round at a limit.
  const Robot& robot = set.scenes[problem.scene].robot;
  const JointVec inside = clamp_to_limits(robot.arm, as_span(q));
  return reaches(robot, *problem.X_WT, {inside.data(), inside.data() + inside.size()});
}

Result<PathFault> fault_at_corners(const NearSet& set, const NearProblem& problem,
                                   std::span<const std::vector<double>> path) {
  const Arm& arm = set.scenes[problem.scene].robot.arm;
  if (path.empty() ||
      !std::ranges::all_of(path, [&](const std::vector<double>& q) { return is_row(arm, q); })) {
    return PathFault::shape;
  }
  if (!is_close(joint_vec(path.front()), problem.start)) return PathFault::start;
  const Result<bool> met = meets_goal(set, problem, joint_vec(path.back()));
  if (!met) return fail(met.error());
  if (!*met) return PathFault::goal;
  const bool inside = std::ranges::all_of(
      path, [&](const std::vector<double>& q) { return within_limits(arm, q, -kJointTol); });
  return inside ? PathFault::none : PathFault::limits;
}

/// Where a path first touches something; nothing where it does not.
Result<std::optional<ContactPoint>> first_touch(ExactChecker& exact,
                                                std::span<const std::vector<double>> path) {
  for (std::size_t i = 1; i < path.size(); ++i) {
    const auto touched = first_contact(exact, path[i - 1], path[i], kContactSpacing);
    if (!touched) return fail(touched.error());
    if (*touched) return (*touched)->contact;
  }
  return std::optional<ContactPoint>();
}

/// [m] of the deepest contact on a path.
Result<double> greatest_depth(ExactChecker& exact, std::span<const std::vector<double>> path) {
  double depth = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const JointVec from = joint_vec(path[i - 1]), way = joint_vec(path[i]) - from;
    const int steps = std::max(1, static_cast<int>(std::ceil(way.norm() / kContactSpacing)));
    for (int k = 0; k <= steps; ++k) {
      const auto report =
          exact.check(as_span(JointVec(from + way * (static_cast<double>(k) / steps))));
      if (!report) return fail(report.error());
      if (!report->free) depth = std::max(depth, report->contacts.front().depth);
    }
  }
  return depth;
}

}  // namespace

Result<PathVerdict> judge_near_path(const NearSet& set, const NearProblem& problem,
                                    ExactChecker& exact,
                                    std::span<const std::vector<double>> path) {
  PathVerdict verdict;
  const Result<PathFault> fault = fault_at_corners(set, problem, path);
  if (!fault) return fail(fault.error());
  verdict.fault = *fault;
  if (verdict.fault == PathFault::shape) return verdict;
  for (std::size_t i = 1; i < path.size(); ++i) {
    verdict.cost += (joint_vec(path[i]) - joint_vec(path[i - 1])).norm();
  }
  const auto touched = first_touch(exact, path);
  if (!touched) return fail(touched.error());
  if (!*touched) return verdict;
  if (verdict.fault == PathFault::none) {
    const GeomPair& pair = (*touched)->pair;
    const bool world = pair.body1 == "world" || pair.body2 == "world";
    verdict.fault = world ? PathFault::obstacle : PathFault::self;
  }
  const Result<double> depth = greatest_depth(exact, path);
  if (!depth) return fail(depth.error());
  verdict.depth = *depth;
  return verdict;
}

Result<void> judge_near_answers(const NearSet& set, std::span<SolvedProblem> answers) {
  std::vector<ExactChecker> exact;
  for (const NearScene& scene : set.scenes) {
    exact.emplace_back(scene.robot.model, scene.robot.arm, ExactOptions{.margin = 0});
  }
  for (SolvedProblem& answer : answers) {
    if (answer.path.empty()) continue;
    const NearProblem& problem = set.problems[answer.problem];
    const auto verdict = judge_near_path(set, problem, exact[problem.scene], answer.path);
    if (!verdict) return fail(verdict.error());
    answer.verdict = *verdict;
  }
  return {};
}

}  // namespace mjarm::app
