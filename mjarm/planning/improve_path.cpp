#include <utility>

#include "mjarm/planning/search_internal.hpp"

namespace mjarm {
namespace {

constexpr int kSamplesOfRound = 1000;  // a round that finds nothing by then ends
constexpr double kShare = 3;       // of the best cost: a raw path must be below, as cuts shorten it
constexpr int kCuts = 40;          // attempts at once
constexpr int kTurns = 8;          // of those, at most,
constexpr double kPays = 0.005;    // as long as each saves this share
constexpr double kPromise = 1.15;  // and the path is not longer than the best one by this factor
constexpr double kProofShare = 0.93;  // of the time; the rest is for the last cuts and the proof

/// Shortens a path as long as that pays and it may become shorter than `cost`.
void settle(const detail::SearchProblem& problem, PlanOptions options, double cost, RawPath& path) {
  double length = path_length(path.q);
  for (int k = 0; k < kTurns; ++k) {
    const double before = length;
    options.seed += 1000003;
    detail::shorten(problem.checker, problem.tilt ? &*problem.tilt : nullptr, options, kCuts, path);
    length = path_length(path.q);
    if (length > kPromise * cost || length > (1 - kPays) * before) return;
  }
}

}  // namespace

RawPath improve_path(const FastChecker& checker, std::span<const double> start,
                     std::span<const double> goals, RawPath best, const PlanOptions& options,
                     double left_us) {
  auto problem = detail::look_at_problem(checker, start, goals, options);
  if (!problem) return best;
  const bool timed = options.time_budget > 0;
  if (timed && left_us <= 0) return best;
  if (timed) problem->deadline = detail::Deadline(kProofShare * left_us);
  PlanOptions round = options;
  round.samples = kSamplesOfRound;
  settle(*problem, round, path_length(best.q), best);
  double cost = path_length(best.q);
  const double least = detail::distance(start, problem->goals.front()) * (1 + 1e-12);
  for (int k = 0; cost > least && (timed ? !problem->deadline.passed() : k < options.rounds); ++k) {
    ++round.seed;
    problem->most_cost = kShare * cost;
    Result<RawPath, PlanFailure> found = detail::rrt_connect(*problem, round);
    if (!found) continue;
    settle(*problem, round, cost, *found);
    const double length = path_length(found->q);
    if (!(length < cost)) continue;
    best = std::move(*found);
    cost = length;
  }
  return best;
}

}  // namespace mjarm
