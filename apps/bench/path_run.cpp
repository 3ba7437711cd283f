#include "apps/bench/path_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/peers.hpp"
#include "apps/bench/robots.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/path/solve_path.hpp"

namespace mjarm::app {
namespace {

constexpr double kFlip = 0.5;  // [rad or m] a longer step between given poses is a flip

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

double step(const std::vector<double>& from, const std::vector<double>& to) {
  double longest = 0;
  for (std::size_t i = 0; i < std::min(from.size(), to.size()); ++i) {
    longest = std::max(longest, std::abs(to[i] - from[i]));
  }
  return longest;
}

}  // namespace

std::optional<PathRun> run_path(const PathProblem& problem, const PathSet& set, int rounds,
                                const std::function<bool()>& advance) {
  const IkSolver ik(problem.robot.arm);
  PathRun run{{.who = "mjarm", .set = set.name, .timed = "c++"}};
  run.us.assign(set.paths.size(), std::numeric_limits<double>::infinity());
  run.paths.resize(set.paths.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < set.paths.size(); ++i) {
      const Stopwatch watch;
      // As `mjarm path` without a start: of all tracks the one with most room.
      const auto answer =
          solve_path(ik, set.paths[i], as_span(problem.robot.arm.home), {.comfort = 0});
      run.us[i] = std::min(run.us[i], watch.us());
      if (round == 0) run.paths[i] = followed(problem.robot.arm, answer);
    }
    if (!advance()) return std::nullopt;
  }
  return run;
}

Result<std::vector<PathRun>> run_path_peers(const PathProblem& problem,
                                            const std::filesystem::path& environment, int rounds) {
  Result<JsonDoc> job = robot_job(problem.robot);
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
  job->set("rounds", rounds);
  job->set("seeds", problem.seeds);
  job->set("sets", std::move(sets));
  std::vector<PathRun> runs;
  const auto take = [&](BenchEntry entry, const JsonValue& line) -> Result<void> {
    PathRun run{std::move(entry)};
    for (auto& q : tables_in(line, "q")) run.paths.push_back({.q = std::move(q)});
    runs.push_back(std::move(run));
    return {};
  };
  const auto done = run_peers(environment, "following", std::move(*job), take);
  if (!done) return fail(done.error());
  return runs;
}

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

std::vector<Msg> path_columns() {
  return {msg::bench_path_complete, msg::bench_path_step, msg::bench_path_flips,
          msg::bench_path_off, msg::bench_path_cause};
}

BenchEntry path_entry(const PathSet& set, const PathRun& run) {
  BenchEntry entry = run;
  int complete = 0, off = 0, flips = 0;
  double max_step = 0;
  std::string cause;
  std::vector<JsonDoc> stopped;
  for (std::size_t i = 0; i < run.paths.size(); ++i) {
    const FollowedPath& path = run.paths[i];
    complete += path.complete ? 1 : 0;
    off += path.off;
    flips += path.max_step > kFlip ? 1 : 0;
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
  std::string share = std::to_string(complete) + "/" + std::to_string(asked);
  if (asked < set.paths.size()) share += " " + text(msg::bench_first, asked);
  entry.cells = {share, rounded(max_step), std::to_string(flips), std::to_string(off),
                 cause.empty() ? "-" : cause};
  entry.details = {{"cases", asked},
                   {"poses", set.paths.front().size()},
                   {"possible", set.possible},
                   {"complete", complete},
                   {"max_step", max_step},
                   {"flips", flips},
                   {"off", off},
                   {"stopped", std::move(stopped)}};
  return entry;
}

}  // namespace mjarm::app
