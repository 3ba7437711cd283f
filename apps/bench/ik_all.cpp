#include "apps/bench/ik_all.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/peers.hpp"
#include "apps/bench/robots.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/kinematics/ik_all.hpp"

namespace mjarm::app {
namespace {

constexpr std::size_t kBranchPoses = 300;
constexpr int kManyStarts = 10'000;
constexpr double kSameBranch = 1e-3;  // [rad or m]

using Configuration = std::vector<double>;

bool same_branch(const Arm& arm, const Configuration& a, const Configuration& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool hinge = arm.joints[i].type == JointType::hinge;
    const double d = hinge ? std::remainder(a[i] - b[i], 2 * std::numbers::pi) : a[i] - b[i];
    if (std::abs(d) >= kSameBranch) return false;
  }
  return true;
}

bool is_known(const Arm& arm, const std::vector<Configuration>& known, const Configuration& q) {
  return std::ranges::any_of(known, [&](const auto& one) { return same_branch(arm, one, q); });
}

BranchRun run_branches(std::string who, const IkSolver& ik, const IkAllOptions& options,
                       const std::vector<IkCase>& poses, int rounds, Progress& progress) {
  BranchRun run{our_entry(std::move(who), "branches", poses.size())};
  run.q.resize(poses.size());
  in_rounds(rounds, poses.size(), progress, [&](std::size_t i) {
    const Stopwatch watch;
    const auto answers = solve_all(ik, poses[i].X_WT, poses[i].seed, options);
    run.us[i] = std::min(run.us[i], watch.us());
    run.q[i].clear();
    if (!answers) return;
    for (const IkSolution& answer : *answers) {
      run.q[i].emplace_back(answer.q.begin(), answer.q.end());
    }
  });
  return run;
}

std::vector<BranchRun> run_our_branches(const IkProblem& problem, const std::vector<IkCase>& poses,
                                        int rounds) {
  const IkSolver ik(problem.robot.arm);
  // At the tolerance of a single answer, points along a curve that is nearly singular count as
  // branches.
  constexpr double kTight = 1e-10;  // [m], [rad]
  const IkSolver search(problem.robot.arm,
                        {.pos_tol = kTight, .rot_tol = kTight, .closed_form = false});
  Progress progress(text(msg::bench_ik_progress, problem.name),
                    2 * static_cast<std::size_t>(rounds) + 1);
  std::vector<BranchRun> runs;
  runs.push_back(run_branches("mjarm", ik, {}, poses, rounds, progress));
  runs.push_back(run_branches("mjarm search", search, {}, poses, rounds, progress));
  runs.push_back(run_branches(text(msg::bench_ik_all_starts, kManyStarts), search,
                              {.starts = kManyStarts}, poses, 1, progress));
  return runs;
}

Result<std::vector<BranchRun>> run_all_peers(const IkProblem& problem,
                                             const std::vector<IkCase>& poses,
                                             const std::string& environment, int rounds) {
  Result<JsonDoc> job = robot_job(problem.robot, rounds);
  if (!job) return fail(std::move(job.error()));
  job->set("cases", cases_json({"branches", true, poses}));
  return peer_runs<BranchRun>(
      environment, "ik_all", std::move(*job),
      [](const JsonValue& line, BranchRun& run) { run.q = tables_in(line, "q"); });
}

}  // namespace

Result<std::vector<BranchCount>> count_branches(const Robot& robot,
                                                const std::vector<IkCase>& poses,
                                                const std::vector<BranchRun>& runs) {
  std::vector<BranchCount> counts(runs.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    std::vector<Configuration> known;
    std::vector<std::vector<Configuration>> right(runs.size());
    for (std::size_t r = 0; r < runs.size(); ++r) {
      if (i >= runs[r].q.size()) continue;
      for (const Configuration& q : runs[r].q[i]) {
        const Result<bool> fine = reaches(robot, poses[i].X_WT, q);
        if (!fine) return fail(fine.error());
        counts[r].false_ok += *fine ? 0 : 1;
        if (!*fine || is_known(robot.arm, right[r], q)) continue;
        right[r].push_back(q);
        if (!is_known(robot.arm, known, q)) known.push_back(q);
      }
    }
    for (std::size_t r = 0; r < runs.size(); ++r) {
      if (i >= runs[r].q.size()) continue;
      counts[r].known += static_cast<int>(known.size());
      counts[r].found += static_cast<int>(std::ranges::count_if(
          known, [&](const auto& q) { return is_known(robot.arm, right[r], q); }));
    }
  }
  return counts;
}

namespace {

Result<BenchResult> measure_ik_all(const BenchOptions& options, const std::string& robot,
                                   int rounds) {
  const auto seed = parse_whole("--seed", options.seed);
  if (!seed) return fail(seed.error());
  const auto problem = load_ik_problem({.robot = robot, .tip = options.tip}, options.data, *seed);
  if (!problem) return fail(problem.error());
  std::vector<IkCase> poses = problem->sets.front().cases;
  poses.resize(std::min(poses.size(), kBranchPoses));
  std::vector<BranchRun> runs = run_our_branches(*problem, poses, rounds);
  if (interrupted()) return fail(stopped());
  BenchResult result{problem->name, problem->robot.model.file().filename().string()};
  if (wants_peers(options.peers, problem->name)) {
    auto theirs = run_all_peers(*problem, poses, options.peers, rounds);
    if (!theirs) return fail(std::move(theirs.error()));
    std::ranges::move(*theirs, std::back_inserter(runs));
  }
  const auto counts = count_branches(problem->robot, poses, runs);
  if (!counts) return fail(counts.error());
  std::size_t at = 0;
  return judged(
      std::move(result), std::move(runs),
      [&](BranchRun& run) -> Result<int> {
        const BranchCount& count = (*counts)[at++];
        run.cells = {count_of(count.found, static_cast<std::size_t>(count.known),
                              static_cast<std::size_t>(count.known)),
                     std::to_string(count.known - count.found)};
        run.details = {{"poses", run.q.size()},
                       {"found", count.found},
                       {"known", count.known},
                       {"missed", count.known - count.found},
                       {"false_ok", count.false_ok}};
        return count.false_ok;
      },
      msg::bench_ik_wrong);
}

}  // namespace

BenchVariant ik_all_variant() {
  return {"--all",
          msg::bench_ik_option_all,
          {msg::bench_ik_branches, msg::bench_ik_missed},
          measure_ik_all};
}

}  // namespace mjarm::app
