#include <algorithm>
#include <utility>

#include "apps/bench/ik.hpp"
#include "apps/bench/messages/bench.hpp"
#include "apps/bench/peers.hpp"
#include "apps/bench/robots.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/kinematics/ik_batch.hpp"
#include "mjarm/rl/reach_env.hpp"

namespace mjarm::app {
namespace {

constexpr std::size_t kBatch = 100'000;             // poses
constexpr int kReachWorlds = 16, kReachSteps = 50;  // of the environment, in a round
constexpr int kTurns = 4;                           // of C++ and Python

/// The reachable poses over and over.
std::vector<Pose> many_poses(const IkCaseSet& set) {
  std::vector<Pose> out;
  while (out.size() < kBatch) out.push_back(set.cases[out.size() % set.cases.size()].X_WT);
  return out;
}

/// Best mean time of a pose, all in one call.
IkRun run_batch(const IkProblem& problem, int rounds) {
  const IkSolver ik(problem.robot.arm);
  const std::vector<Pose> poses = many_poses(problem.sets.front());
  IkRun run{our_entry("mjarm", "batch", 1)};
  for (int round = 0; round < rounds && !interrupted(); ++round) {
    const Stopwatch watch;
    const auto answers = solve_batch(ik, poses, as_span(problem.robot.arm.home), {.threads = 1});
    run.us[0] = std::min(run.us[0], watch.us() / static_cast<double>(answers.size()));
  }
  return run;
}

/// Best mean time of an action of one world, many being stepped together.
Result<IkRun> run_reach(int rounds) {
  const rl::ReachOptions task{.environments = kReachWorlds, .threads = 1};
  const Result<Model> model = rl::reach_model(task);
  if (!model) return fail(model.error());
  Result<rl::ReachEnv> env = rl::ReachEnv::create(*model, task);
  if (!env) return fail(std::move(env.error()));
  const std::vector<float> still(static_cast<std::size_t>(kReachWorlds * env->action_size()));
  IkRun run{our_entry("mjarm", "reach", 1)};
  for (int round = 0; round < rounds && !interrupted(); ++round) {
    if (auto begun = env->reset(1); !begun) return fail(begun.error());
    const Stopwatch watch;
    for (int step = 0; step < kReachSteps; ++step) {
      if (auto done = env->step(still); !done) return fail(done.error());
    }
    run.us[0] = std::min(run.us[0], watch.us() / (kReachWorlds * kReachSteps));
  }
  return run;
}

/// `bench/peers/python.py`
/// @param peers  the names of those that run; empty = all of them.
Result<std::vector<IkRun>> run_python_peers(const IkProblem& problem,
                                            const std::filesystem::path& environment, int rounds,
                                            const std::vector<std::string>& peers) {
  Result<JsonDoc> job = robot_job(problem.robot, rounds);
  if (!job) return fail(std::move(job.error()));
  job->set("cases", cases_json(problem.sets.front()));
  job->set("batch", kBatch);
  job->set("worlds", kReachWorlds);
  job->set("steps", kReachSteps);
  job->set("peers", peers);
  return peer_runs<IkRun>(environment, "python", std::move(*job),
                          [](const JsonValue& line, IkRun& run) { run.q = rows_in(line, "q"); });
}

Result<std::vector<IkRun>> run_ours(const IkProblem& problem, int rounds) {
  std::vector<IkRun> runs = run_ik(problem, rounds);
  std::erase_if(runs, [](const IkRun& run) { return run.who != "mjarm" || run.us.size() < 2; });
  runs.push_back(run_batch(problem, rounds));
  Result<IkRun> reach = run_reach(rounds);
  if (!reach) return fail(std::move(reach.error()));
  runs.push_back(std::move(*reach));
  return runs;
}

/// Takes over what went faster when the same was measured `again`.
void keep_best(std::vector<IkRun>& runs, const std::vector<IkRun>& again) {
  for (IkRun& run : runs) {
    for (const IkRun& other : again) {
      if (run.who != other.who || run.set != other.set) continue;
      const std::size_t count = std::min(run.us.size(), other.us.size());
      for (std::size_t i = 0; i < count; ++i) run.us[i] = std::min(run.us[i], other.us[i]);
    }
  }
}

/// Runs the peers, then the C++ calls and the package of Python in turns, for their difference is
/// smaller than what a shared machine's speed changes by from minute to minute.
Result<std::vector<IkRun>> take_turns(const IkProblem& problem,
                                      const std::filesystem::path& environment, int rounds,
                                      std::vector<IkRun>& ours) {
  Result<std::vector<IkRun>> theirs = run_python_peers(problem, environment, rounds, {});
  for (int turn = 1; theirs && turn < kTurns && !interrupted(); ++turn) {
    const Result<std::vector<IkRun>> again = run_ours(problem, rounds);
    if (!again) return fail(again.error());
    keep_best(ours, *again);
    const Result<std::vector<IkRun>> package =
        run_python_peers(problem, environment, rounds, {"mjarm in Python"});
    if (!package) return fail(package.error());
    keep_best(*theirs, *package);
  }
  return theirs;
}

Result<BenchResult> measure_python(const BenchOptions& options, const std::string& robot,
                                   int rounds) {
  auto problem = load_ik_problem({.robot = robot, .tip = options.tip}, options.data);
  if (!problem) return fail(std::move(problem.error()));
  problem->sets.resize(1);  // those that can be reached
  problem->paths.clear();
  problem->q.clear();
  Result<std::vector<IkRun>> runs = run_ours(*problem, rounds);
  if (!runs) return fail(std::move(runs.error()));
  if (interrupted()) return fail(stopped());
  if (wants_peers(options.peers, problem->name)) {
    Result<std::vector<IkRun>> theirs = take_turns(*problem, options.peers, rounds, *runs);
    if (!theirs) return fail(std::move(theirs.error()));
    std::ranges::move(*theirs, std::back_inserter(*runs));
  }
  const auto judge_run = [&](IkRun& run) { return judge_and_describe(*problem, run); };
  return judged({problem->name, problem->robot.model.file().filename().string()}, std::move(*runs),
                judge_run, msg::bench_ik_wrong);
}

}  // namespace

Command python_suite() {
  return {"python", msg::bench_python_summary, msg::bench_python_examples, [](CLI::App& app) {
            return setup_robots(app, msg::bench_ik_option_data, true, {msg::bench_ik_right},
                                measure_python);
          }};
}

}  // namespace mjarm::app
