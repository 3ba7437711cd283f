#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "apps/bench/plan_judge.hpp"
#include "apps/bench/plan_sets.hpp"
#include "apps/bench/report.hpp"
#include "mjarm/planning/plan_path.hpp"

namespace mjarm::app {

/// What became of one problem.
struct SolvedProblem {
  std::size_t problem = 0;                     ///< index into PlanSet::cases
  std::vector<std::vector<double>> path = {};  ///< corners; empty: none
  double us = 0;                               ///< [us] from the obstacles to the finished path
  double world_us = 0;                         ///< [us] of it, to take in the obstacles
  PathVerdict verdict = {};
};

/// What one contestant did on some problems of one set.
struct PlanRun : BenchEntry {
  std::vector<SolvedProblem> answers = {};
};

/// Solves each of these problems once, in this thread, by answer_problem(), as `mjarm plan` does;
/// the time is that of the obstacles taken in, the search, the shortening and the proof. The paths
/// are judged afterwards.
[[nodiscard]] PlanRun run_plan(const PlanSet& set, std::span<const std::size_t> problems,
                               const PlanOptions& options);

/// Judges the paths of these answers, ours or a peer's, by judge_path(); where there is none, the
/// verdict stays as it is.
void judge_answers(const PlanSet& set, std::span<SolvedProblem> answers);

/// [ns] of one state check, the mean over many states: configurations anywhere within the limits,
/// each with an answer of its own; the same in blocks as wide as a register, asked whether all of
/// a block are free; and 16 along each of many straight edges of 1 rad, each with its answer.
struct CheckTimes {
  double random_ns = 0;
  double together_ns = 0;
  double along_ns = 0;
};
/// Measures FastChecker::check() and all_free() in the worlds of up to 50 problems, all over the
/// set; the fastest of some rounds counts.
[[nodiscard]] Result<CheckTimes> run_checks(const PlanSet& set, std::uint64_t seed);

}  // namespace mjarm::app
