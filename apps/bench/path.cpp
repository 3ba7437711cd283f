#include <algorithm>
#include <memory>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/path_run.hpp"
#include "apps/bench/suite.hpp"
#include "apps/bench/suites.hpp"

namespace mjarm::app {
namespace {

/// Paths of mjarm that it calls whole and that are not.
int wrong_paths(const PathRun& run) {
  return static_cast<int>(
      std::count_if(run.paths.begin(), run.paths.end(), [](const FollowedPath& path) {
        return path.off > 0 || (path.cause.empty() && !path.complete);
      }));
}

Result<BenchResult> measure(const ToolBenchOptions& options, const std::string& robot, int rounds) {
  const auto problem = load_path_problem({.robot = robot, .tip = options.tip}, options.data);
  if (!problem) return fail(problem.error());
  auto runs = run_sets<PathRun>(text(msg::bench_path_progress, problem->name), problem->sets,
                                rounds, [&](const PathSet& set, const Advance& advance) {
                                  return run_path(*problem, set, rounds, advance);
                                });
  if (!runs) return fail(std::move(runs.error()));
  const auto run_peers = [&] { return run_path_peers(*problem, options.peers, rounds); };
  if (auto added = add_peers(options, problem->name, *runs, run_peers); !added) {
    return fail(std::move(added.error()));
  }
  BenchResult result{problem->name, problem->robot.model.file().filename().string(), {}};
  int wrong = 0;
  for (PathRun& run : *runs) {
    const auto set = std::find_if(problem->sets.begin(), problem->sets.end(),
                                  [&](const PathSet& known) { return known.name == run.set; });
    if (set == problem->sets.end()) {  // a peer that failed
      result.entries.push_back(run);
      continue;
    }
    if (Result<void> judged = judge(*problem, *set, run); !judged) return fail(judged.error());
    wrong += run.version.empty() ? wrong_paths(run) : 0;
    result.entries.push_back(path_entry(*set, run));
  }
  if (wrong > 0) result.wrong = text(msg::bench_path_wrong, result.robot, wrong);
  return result;
}

}  // namespace

BenchSuite add_bench_path(CLI::App& bench) {
  auto options = std::make_shared<ToolBenchOptions>();
  CLI::App& app = add_subcommand(bench, "path", msg::bench_path_summary, msg::bench_path_examples);
  add_tool_bench_options(app, *options, msg::bench_path_option_data);
  return {&app, [options] {
            return run_suite(*options, {"ur5e", "panda"}, path_columns(),
                             [&](const std::string& robot, int rounds) {
                               return measure(*options, robot, rounds);
                             });
          }};
}

}  // namespace mjarm::app
