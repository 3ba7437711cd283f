#include "mjarm/planning/plan_path.hpp"

#include <algorithm>
#include <utility>

#include "mjarm/collision/prove_edge.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/planning/clear_path_internal.hpp"
#include "mjarm/planning/search_internal.hpp"

namespace mjarm {
namespace {

/// certify_edge() or prove_edge().
using Certify = Result<EdgeCertificate, EdgeResult>(const FastChecker&, std::span<const double>,
                                                    std::span<const double>, const EdgeOptions&);

/// Certificates of all edges; false where one is not proved.
bool prove(const FastChecker& checker, std::span<const JointVec> q, double resolution,
           Certify& certify, std::vector<EdgeCertificate>& out) {
  out.clear();
  for (std::size_t i = 1; i < q.size(); ++i) {
    auto proof = certify(checker, as_span(q[i - 1]), as_span(q[i]), {resolution});
    if (!proof) return false;
    out.push_back(std::move(*proof));
  }
  return true;
}

}  // namespace

double path_length(std::span<const JointVec> q) noexcept {
  double sum = 0;
  for (std::size_t i = 1; i < q.size(); ++i) sum += (q[i] - q[i - 1]).norm();
  return sum;
}

Result<RawPath, PlanFailure> find_path(const FastChecker& checker, std::span<const double> start,
                                       std::span<const JointVec> goals,
                                       const PlanOptions& options) {
  auto problem = detail::validate_problem(checker, start, goals, options);
  if (!problem) return tl::unexpected(problem.error());
  problem->deadline = detail::Deadline(options.stop, 1e6 * options.time_limit);
  const auto search = options.planner == Planner::rrt_star ? detail::rrt_star
                      : options.planner == Planner::ompl   ? detail::ompl_search
                                                           : detail::rrt_connect;
  Result<RawPath, PlanFailure> found = search(*problem, options);
  if (is_stopped(options.stop)) return tl::unexpected(PlanFailure{.code = PlanErrc::stopped});
  if (!found && found.error().code == PlanErrc::budget_spent && problem->deadline.passed()) {
    found.error().code = PlanErrc::out_of_time;
    found.error().limit = options.time_limit;
  }
  return found;
}

namespace {

Result<PlannedPath, PlanFailure> finish(const FastChecker& checker, RawPath path,
                                        const PlanOptions& options, Certify& certify) {
  PlannedPath out;
  out.goal = path.goal;
  std::vector<JointVec> found = path.q;
  const auto keeper = detail::PathKeeper::create(options, checker.robot().arm());
  const detail::PathKeeper* const kept = keeper ? &*keeper : nullptr;
  detail::shorten(checker, kept, options, options.shortcuts, path);
  // Parts of proved edges are free, but the proof of a part is another one and may need more.
  for (std::vector<JointVec>* q : {&path.q, &found}) {
    for (const double share : {1.0, 0x1p-3, 0x1p-6}) {
      if (is_stopped(options.stop)) {
        return tl::unexpected(PlanFailure{.code = PlanErrc::stopped});
      }
      if (!prove(checker, *q, share * options.resolution, certify, out.proof)) continue;
      out.q = *q;
      if (!detail::prove_kept(kept, options, out)) break;  // no resolution helps
      out.cost = path_length(out.q);
      out.counts = path.counts;
      out.trees = std::move(path.trees);
      return out;
    }
  }
  PlanFailure failure;
  failure.code = PlanErrc::unproved;
  return tl::unexpected(failure);
}

Result<PlannedPath, PlanFailure> plan_with(Certify& certify, const FastChecker& checker,
                                           std::span<const double> start,
                                           std::span<const JointVec> goals,
                                           const PlanOptions& options, PlanTimes* times) {
  const Stopwatch watch;
  Result<RawPath, PlanFailure> raw = find_path(checker, start, goals, options);
  const bool again = options.rounds > 0 || options.time_budget > 0;
  if (raw && again && options.planner != Planner::ompl) {
    const double left_us = 1e6 * options.time_budget - watch.us();
    *raw = improve_path(checker, start, goals, std::move(*raw), options, left_us);
  }
  if (times != nullptr) times->search_us = watch.us();
  if (!raw) return tl::unexpected(raw.error());
  Result<PlannedPath, PlanFailure> out = finish(checker, std::move(*raw), options, certify);
  if (times != nullptr) times->finish_us = watch.us() - times->search_us;
  return out;
}

}  // namespace

Result<PlannedPath, PlanFailure> finish_path(const FastChecker& checker, RawPath path,
                                             const PlanOptions& options) {
  return finish(checker, std::move(path), options, certify_edge);
}

Result<PlannedPath, PlanFailure> plan_path(const FastChecker& checker,
                                           std::span<const double> start,
                                           std::span<const JointVec> goals,
                                           const PlanOptions& options, PlanTimes* times) {
  return plan_with(certify_edge, checker, start, goals, options, times);
}

Result<PlannedPath, PlanFailure> detail::plan_unmeasured(const FastChecker& checker,
                                                         std::span<const double> start,
                                                         std::span<const JointVec> goals,
                                                         const PlanOptions& options,
                                                         PlanTimes* times) {
  return plan_with(prove_edge, checker, start, goals, options, times);
}

}  // namespace mjarm
