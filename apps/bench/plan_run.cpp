#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/plan.hpp"
#include "apps/bench/robots.hpp"
#include "mjarm/collision/fast_check.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/planning/plan_answer.hpp"

namespace mjarm::app {
namespace {

/// [us] to take in the obstacles of a problem.
double world_us(const PlanSet& set, const PlanProblem& problem) {
  const Stopwatch watch;
  const Result<FastChecker> checker = FastChecker::create(set.robot, problem.obstacles);
  return watch.us();
}

SolvedProblem solve(const PlanSet& set, std::size_t index, const PlanOptions& options) {
  const PlanAnswer answer = answer_problem(set.robot, set.cases[index], options);
  SolvedProblem solved{.problem = index, .us = answer.us + answer.simplify_us};
  if (!answer.path) return solved;
  for (const JointVec& q : answer.path->q) solved.path.emplace_back(q.data(), q.data() + q.size());
  return solved;
}

void add_row(std::vector<double>& rows, const JointVec& q) {
  rows.insert(rows.end(), q.data(), q.data() + q.size());
}

std::vector<double> random_states(const Arm& arm, std::size_t count, Rng& rng) {
  std::vector<double> rows;
  for (std::size_t i = 0; i < count; ++i) add_row(rows, random_q(arm, rng));
  return rows;
}

std::vector<double> states_along(const Arm& arm, std::size_t count, Rng& rng) {
  constexpr int kOnEdge = 16;
  constexpr double kLength = 1;  // [rad or m, L2]
  std::vector<double> rows;
  for (std::size_t i = 0; i < count; i += kOnEdge) {
    const JointVec from = random_q(arm, rng), way = random_q(arm, rng) - from;
    const double share = std::min(1.0, kLength / std::max(way.norm(), 1e-9));
    for (int k = 0; k < kOnEdge; ++k) add_row(rows, from + way * (share * k / (kOnEdge - 1)));
  }
  return rows;
}

/// A checker and the states it is asked about.
struct CheckJob {
  FastChecker checker;
  std::vector<double> random, along;
};

/// @param look  what is done with a job.
template <class Look>
double mean_ns(const std::vector<CheckJob>& jobs, std::size_t states, const Look& look) {
  constexpr double kEnough = 3e5;  // [us] of rounds, where they are long
  constexpr int kRounds = 50;
  double best = std::numeric_limits<double>::infinity(), spent = 0;
  for (int round = 0; round < kRounds && spent < kEnough; ++round) {
    const Stopwatch watch;
    for (const CheckJob& job : jobs) look(job);
    const double us = watch.us();
    best = std::min(best, us);
    spent += us;
  }
  return 1e3 * best / static_cast<double>(states * jobs.size());
}

/// How many blocks of the random configurations have none in collision.
std::size_t count_free_blocks(const CheckJob& job) {
  const std::span<const double> rows(job.random);
  const auto block = static_cast<std::size_t>(job.checker.width() * job.checker.robot().dof());
  std::size_t count = 0;
  for (std::size_t first = 0; first < rows.size(); first += block) {
    const std::size_t rest = std::min(block, rows.size() - first);
    count += job.checker.all_free(rows.subspan(first, rest)) ? 1 : 0;
  }
  return count;
}

/// Solves each of these problems once, in this thread, by answer_problem(), as `mjarm plan` does;
/// the time is that of the obstacles taken in, the search, the shortening and the proof. The paths
/// are judged afterwards.
PlanRun run_plan(const PlanSet& set, std::string name, std::span<const std::size_t> problems,
                 const PlanOptions& options) {
  PlanRun run{our_entry("mjarm", std::move(name), 0)};
  for (const std::size_t index : problems) run.answers.push_back(solve(set, index, options));
  for (SolvedProblem& answer : run.answers) {
    answer.world_us = world_us(set, set.cases[answer.problem]);
  }
  // After all clocks: peers too answer problem after problem, and judging leaves caches cold.
  judge_answers(set, run.answers);
  return run;
}

/// Measures FastChecker::check() and all_free() in the worlds of up to 50 problems, all over the
/// set; the fastest of some rounds counts.
Result<void> add_checks(const PlanSet& set, std::uint64_t seed, PlanTable& table) {
  constexpr std::size_t kWorlds = 50, kStates = 1024;
  const std::size_t every = (set.cases.size() + kWorlds - 1) / kWorlds;
  Rng rng(seed);
  std::vector<CheckJob> jobs;
  for (std::size_t i = 0; i < set.cases.size(); i += every) {
    Result<FastChecker> checker = FastChecker::create(set.robot, set.cases[i].obstacles);
    if (!checker) return fail(std::move(checker.error()));
    jobs.push_back({std::move(*checker), random_states(set.arm, kStates, rng),
                    states_along(set.arm, kStates, rng)});
  }
  std::vector<std::uint8_t> free(kStates);
  CheckTimes& out = table.checks.emplace_back();
  out.random_ns =
      mean_ns(jobs, kStates, [&](const CheckJob& j) { j.checker.check(j.random, free); });
  out.together_ns = mean_ns(jobs, kStates, count_free_blocks);
  out.along_ns = mean_ns(jobs, kStates, [&](const CheckJob& j) { j.checker.check(j.along, free); });
  return {};
}

std::vector<std::size_t> all_of(const PlanSet& set) {
  std::vector<std::size_t> indices(set.cases.size());
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

/// The first problem once more, so that what is there for the first time costs nobody anything.
void warm_up(const PlanSet& set, const PlanOptions& options) {
  const std::size_t first[] = {0};
  (void)run_plan(set, {}, first, options);
}

Result<void> add_plan_peers(const PlanSet& set, const PlanScene& scene, const PlanPeers& peers,
                            PlanTable& table) {
  if (peers.environment.empty()) return {};
  auto runs = run_plan_peers(set, scene, peers);
  if (!runs) return fail(std::move(runs.error()));
  for (PlanRun& run : *runs) {
    if (run.error.empty()) run.set = scene.name;
    table.runs.push_back(std::move(run));
  }
  return {};
}

/// One step of the work is done.
Result<void> advance(Progress& progress) {
  progress.advance();
  return interrupted() ? Result<void>(fail(stopped())) : Result<void>();
}

}  // namespace

Result<PlanTable> run_plan_set(const PlanSet& set, std::uint64_t seed, const PlanPeers& peers,
                               Progress& progress) {
  PlanTable table = table_of(set);
  table.sum = true;
  const PlanOptions options{.seed = seed};
  warm_up(set, options);
  Result<void> done;
  for (const PlanScene& scene : scenes_of(set)) {
    table.runs.push_back(run_plan(set, scene.name, scene.problems, options));
    done = add_plan_peers(set, scene, peers, table);
    if (done) done = advance(progress);
    if (!done) return fail(std::move(done.error()));
  }
  done = add_checks(set, seed, table);
  if (!done) return fail(std::move(done.error()));
  return table;
}

Result<PlanTable> run_anytime(const PlanSet& set, std::uint64_t seed, Progress& progress) {
  PlanTable table = table_of(set);
  PlanOptions options{.seed = seed};
  warm_up(set, options);
  for (const int milliseconds : {0, 2, 10}) {
    options.time_budget = 1e-3 * milliseconds;
    const std::string name = milliseconds == 0 ? text(msg::bench_plan_no_budget)
                                               : text(msg::bench_plan_budget, milliseconds);
    table.runs.push_back(run_plan(set, name, all_of(set), options));
    if (auto done = advance(progress); !done) return fail(std::move(done.error()));
  }
  return table;
}

Result<PlanTable> run_crowds(const std::vector<CrowdedSet>& crowds, std::uint64_t seed,
                             Progress& progress) {
  PlanTable table;
  const PlanOptions options{.seed = seed};
  for (const CrowdedSet& crowd : crowds) {
    warm_up(crowd.set, options);
    const Msg kind = crowd.points ? msg::bench_plan_crowd_points : msg::bench_plan_crowd_boxes;
    const std::string name = text(kind, crowd.obstacles);
    table.runs.push_back(run_plan(crowd.set, name, all_of(crowd.set), options));
    Result<void> done = add_checks(crowd.set, seed, table);
    if (done) done = advance(progress);
    if (!done) return fail(std::move(done.error()));
  }
  return table;
}

}  // namespace mjarm::app
