#include <algorithm>
#include <utility>

#include "mjarm/collision/prove_edge.hpp"
#include "mjarm/planning/clear_path_internal.hpp"
#include "mjarm/planning/search_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr std::size_t kMaxGoalExits = 8;  // goals nearer to something than the clearance

/// What a search within the clearance ends at.
struct ClearGoals {
  std::vector<JointVec> q;
  std::vector<Exit> exits;  ///< of each
  std::vector<int> index;   ///< of each, in what the user gave
};

ClearGoals clear_goals(const SearchProblem& problem, const FastChecker& wide,
                       const ExitSearch& search, ClearEnds ends, double clearance) {
  ClearGoals out;
  std::size_t tried = 0;
  for (std::size_t g = 0; g < problem.goals.size(); ++g) {
    const JointVec goal = joint_vec(problem.goals[g]);
    std::optional<Exit> exit;
    if (wide.is_free(as_span(goal))) {
      exit = Exit{goal, clearance, {}};
    } else if (ends == ClearEnds::own && tried++ < kMaxGoalExits) {
      exit = search.leave(goal);
    }
    if (!exit) continue;
    out.q.push_back(exit->q);
    out.exits.push_back(std::move(*exit));
    out.index.push_back(problem.goal_index[g]);
  }
  return out;
}

/// A proof that may be finer than that of a search, as an edge may run the other way here.
std::optional<EdgeCertificate> certificate(const FastChecker& checker, const JointVec& from,
                                           const JointVec& to, double resolution) {
  for (const double share : {1.0, 0x1p-3, 0x1p-6}) {
    auto proof = prove_edge(checker, as_span(from), as_span(to), {share * resolution});
    if (proof) return std::move(*proof);
  }
  return std::nullopt;
}

/// Adds an edge that leads away from an end, at the front or at the back.
bool add_exit(const Exit& exit, const JointVec& q, double resolution, bool front,
              PlannedPath& path) {
  if (!exit.narrow) return true;
  const JointVec &from = front ? q : exit.q, &to = front ? exit.q : q;
  auto proof = certificate(*exit.narrow, from, to, resolution);
  if (!proof) return false;
  path.q.insert(front ? path.q.begin() : path.q.end(), q);
  path.proof.insert(front ? path.proof.begin() : path.proof.end(), std::move(*proof));
  path.kept.insert(front ? path.kept.begin() : path.kept.end(), exit.kept);
  return true;
}

/// Puts both ends onto a path between their exits, and proves what that changes.
bool join_ends(const FastChecker& wide, const ExitSearch& search, const PlanOptions& options,
               const JointVec& start, const JointVec& goal, Exit& first, Exit& last,
               PlannedPath& path) {
  const std::vector<JointVec> as_found = path.q;
  search.straighten(start, path.q[1], first);
  path.q.front() = first.q;
  search.straighten(goal, path.q[path.q.size() - 2], last);
  path.q.back() = last.q;
  for (const std::size_t i : {std::size_t{0}, path.proof.size() - 1}) {
    if (path.q[i] == as_found[i] && path.q[i + 1] == as_found[i + 1]) continue;
    auto proof = certificate(wide, path.q[i], path.q[i + 1], options.resolution);
    if (!proof) return false;
    path.proof[i] = std::move(*proof);
  }
  path.kept.assign(path.proof.size(), *options.clearance);
  return add_exit(first, start, options.resolution, true, path) &&
         add_exit(last, goal, options.resolution, false, path);
}

}  // namespace

void measure_edges(const FastChecker& checker, PlannedPath& path) {
  for (std::size_t i = 0; i < path.proof.size(); ++i) {
    EdgeCertificate& proof = path.proof[i];
    std::vector<double> rows;
    for (const EdgeInterval& interval : proof.intervals) {
      const JointVec q = path.q[i] + interval.t * (path.q[i + 1] - path.q[i]);
      rows.insert(rows.end(), q.begin(), q.end());
    }
    const FastChecker::LeastClearance least = checker.least_clearance(rows);
    proof.nearest = least.nearest;
    proof.nearest_t = proof.intervals[least.row].t;
  }
}

bool is_for_clearance(const PlanFailure& why) {
  return why.code == PlanErrc::too_near || why.code == PlanErrc::budget_spent ||
         why.code == PlanErrc::unproved;
}

Result<PlannedPath, PlanFailure> plan_clear(const ClearScene& scene, std::span<const double> start,
                                            std::span<const JointVec> goals,
                                            const PlanOptions& options, ClearEnds ends,
                                            PlanTimes* times) {
  const auto problem = validate_problem(scene.checker, start, goals, options);
  if (!problem) return tl::unexpected(problem.error());
  const FastChecker wide = checker_with(scene, *options.clearance);
  const PathKeeper* const keeper = problem->keeper ? &*problem->keeper : nullptr;
  const ExitSearch search(scene, wide, keeper, options);
  const auto blocked = [&] { return tl::unexpected(too_near(*options.clearance, 0)); };
  const JointVec q_start = joint_vec(start);
  std::optional<Exit> first;
  if (wide.is_free(start)) {
    first = Exit{q_start, *options.clearance, {}};
  } else if (ends == ClearEnds::own) {
    first = search.leave(q_start);
  }
  if (!first) return blocked();
  ClearGoals ways = clear_goals(*problem, wide, search, ends, *options.clearance);
  if (ways.q.empty()) return blocked();
  PlanOptions within = options;
  if (within.samples == 0) within.samples = kClearSamples;
  // What is nearest is measured once, in the end.
  Result<PlannedPath, PlanFailure> path =
      plan_unmeasured(wide, as_span(first->q), ways.q, within, times);
  if (!path) return path;
  const auto reached = static_cast<std::size_t>(path->goal);
  path->goal = ways.index[reached];
  path->clearance = *options.clearance;
  const JointVec& goal = goals[static_cast<std::size_t>(path->goal)];
  if (!join_ends(wide, search, options, q_start, goal, *first, ways.exits[reached], *path) ||
      !prove_kept(keeper, options, *path)) {
    return tl::unexpected(PlanFailure{.code = PlanErrc::unproved});
  }
  measure_edges(scene.checker, *path);
  path->cost = path_length(path->q);
  return path;
}

}  // namespace mjarm::detail
