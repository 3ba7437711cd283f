#include <algorithm>
#include <cmath>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/path_sets.hpp"
#include "apps/bench/peers.hpp"
#include "apps/bench/robots.hpp"
#include "apps/bench/suite.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/path/solve_path.hpp"

namespace mjarm::app {
namespace {

constexpr double kFlip = 0.5;  // [rad or m] a longer step between given poses is a flip

/// What became of one path.
struct FollowedPath {
  std::vector<std::vector<double>> q = {};  ///< [rad or m] as far as it goes, one row a pose
  std::string cause = {};                   ///< why it stops; empty where not known

  bool complete = false;  ///< every pose is met, in steps of `kFlip` at most
  int off = 0;            ///< answers that are not at their pose, or beyond a limit
  double max_step = 0;    ///< [rad or m] largest step between given poses
};

/// What one contestant did on one set of paths.
struct PathRun : BenchEntry {
  std::vector<FollowedPath> paths = {};  ///< one a path; slow peers do only the first ones
};

FollowedPath followed(const Arm& arm, const Result<JointPath, PathFailure>& answer) {
  FollowedPath out;
  const JointPath& path = answer ? *answer : answer.error().partial;
  for (const JointVec& q : path.q) out.q.emplace_back(q.begin(), q.end());
  if (!answer) {
    const PathFailure& failure = answer.error();
    out.cause = name(failure.code);
    if (failure.joint >= 0) {
      out.cause += " " + arm.joints[static_cast<std::size_t>(failure.joint)].name;
    }
    out.cause += " @" + std::to_string(failure.at);
  }
  return out;
}

/// Runs mjarm on every path of a set, all of them `rounds` times over, one call at a time in this
/// thread, each call with a clock reading before and after.
PathRun run_path(const PathProblem& problem, const PathSet& set, int rounds, Progress& progress) {
  const Arm& arm = problem.robot.arm;
  const IkSolver ik(arm);
  PathRun run{our_entry("mjarm", set.name, set.paths.size())};
  run.paths.resize(set.paths.size());
  in_rounds(rounds, set.paths.size(), progress, [&](std::size_t i) {
    const Stopwatch watch;
    // As `mjarm path` without a start: of all tracks the one with most room.
    const auto answer = solve_path(ik, set.paths[i], as_span(arm.home), {.comfort = 0});
    run.us[i] = std::min(run.us[i], watch.us());
    if (run.paths[i].q.empty()) run.paths[i] = followed(arm, answer);
  });
  return run;
}

/// Runs the peers of a Python environment on the same paths (`bench/peers/following.py`).
Result<std::vector<PathRun>> run_path_peers(const PathProblem& problem,
                                            const std::filesystem::path& environment, int rounds) {
  Result<JsonDoc> job = robot_job(problem.robot, rounds);
  if (!job) return fail(std::move(job.error()));
  std::vector<JsonDoc> sets;
  for (const PathSet& set : problem.sets) {
    std::vector<JsonDoc> paths;
    for (const std::vector<Pose>& path : set.paths) {
      std::vector<JsonDoc> poses;
      for (const Pose& X_WT : path) poses.push_back(pose_json(X_WT));
      paths.push_back(std::move(poses));
    }
    sets.push_back({{"name", set.name}, {"paths", std::move(paths)}});
  }
  job->set("seeds", problem.seeds);
  job->set("sets", std::move(sets));
  return peer_runs<PathRun>(environment, "following", std::move(*job),
                            [](const JsonValue& line, PathRun& run) {
                              for (auto& q : tables_in(line, "q")) {
                                run.paths.push_back({.q = std::move(q)});
                              }
                            });
}

double step(const std::vector<double>& from, const std::vector<double>& to) {
  double longest = 0;
  for (std::size_t i = 0; i < std::min(from.size(), to.size()); ++i) {
    longest = std::max(longest, std::abs(to[i] - from[i]));
  }
  return longest;
}

/// Judges every path of `run`, by MuJoCo's own forward kinematics.
Result<void> judge(const PathProblem& problem, const PathSet& set, PathRun& run) {
  run.paths.resize(std::min(run.paths.size(), set.paths.size()));
  for (std::size_t i = 0; i < run.paths.size(); ++i) {
    FollowedPath& path = run.paths[i];
    path.q.resize(std::min(path.q.size(), set.paths[i].size()));
    for (std::size_t k = 0; k < path.q.size(); ++k) {
      const Result<bool> fine = reaches(problem.robot, set.paths[i][k], path.q[k]);
      if (!fine) return fail(fine.error());
      path.off += *fine ? 0 : 1;
      if (k > 0) path.max_step = std::max(path.max_step, step(path.q[k - 1], path.q[k]));
    }
    path.complete = path.q.size() == set.paths[i].size() && path.off == 0 && path.max_step <= kFlip;
  }
  return {};
}

/// The cells of a judged run and, for the JSON document, every path that is not complete.
/// @return how many of mjarm it calls whole, or passes for answers, that are not.
int describe(const PathSet& set, PathRun& run) {
  int complete = 0, off = 0, flips = 0, wrong = 0;
  double max_step = 0;
  std::string cause;
  std::vector<JsonDoc> stopped;
  for (std::size_t i = 0; i < run.paths.size(); ++i) {
    const FollowedPath& path = run.paths[i];
    complete += path.complete ? 1 : 0;
    off += path.off;
    flips += path.max_step > kFlip ? 1 : 0;
    wrong += path.off > 0 || (path.cause.empty() && !path.complete) ? 1 : 0;
    max_step = std::max(max_step, path.max_step);
    if (path.complete) continue;
    if (cause.empty()) cause = path.cause;
    stopped.push_back({{"case", i},
                       {"answers", path.q.size()},
                       {"max_step", path.max_step},
                       {"off", path.off},
                       {"cause", path.cause}});
  }
  const std::size_t asked = run.paths.size();
  run.cells = {count_of(complete, asked, set.paths.size()), rounded(max_step),
               std::to_string(flips), std::to_string(off), cause.empty() ? "-" : cause};
  run.details = {{"cases", asked},
                 {"poses", set.paths.front().size()},
                 {"possible", set.possible},
                 {"complete", complete},
                 {"max_step", max_step},
                 {"flips", flips},
                 {"off", off},
                 {"stopped", std::move(stopped)}};
  return wrong;
}

Result<BenchResult> measure_path(const BenchOptions& options, const std::string& robot,
                                 int rounds) {
  const auto problem = load_path_problem({.robot = robot, .tip = options.tip}, options.data);
  if (!problem) return fail(problem.error());
  Progress progress(text(msg::bench_path_progress, problem->name),
                    problem->sets.size() * static_cast<std::size_t>(rounds));
  std::vector<PathRun> ours;
  for (const PathSet& set : problem->sets) {
    ours.push_back(run_path(*problem, set, rounds, progress));
  }
  const auto judge_run = [&](PathRun& run) -> Result<int> {
    const PathSet* const set = set_named(problem->sets, run.set);
    if (set == nullptr) return 0;  // a peer that failed
    if (Result<void> judged = judge(*problem, *set, run); !judged) return fail(judged.error());
    return describe(*set, run);
  };
  return compare(
      options.peers, {problem->name, problem->robot.model.file().filename().string()},
      std::move(ours), [&] { return run_path_peers(*problem, options.peers, rounds); }, judge_run,
      msg::bench_path_wrong);
}

std::vector<Msg> path_columns() {
  return {msg::bench_path_complete, msg::bench_path_step, msg::bench_path_flips,
          msg::bench_path_off, msg::bench_path_cause};
}

}  // namespace

Command path_suite() {
  return {"path", msg::bench_path_summary, msg::bench_path_examples, [](CLI::App& app) {
            return setup_robots(app, msg::bench_path_option_data, true, path_columns(),
                                measure_path);
          }};
}

}  // namespace mjarm::app
