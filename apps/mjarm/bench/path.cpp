#include <algorithm>
#include <memory>
#include <utility>

#include "apps/mjarm/bench/path_run.hpp"
#include "apps/mjarm/bench/suite.hpp"
#include "apps/mjarm/bench/suites.hpp"
#include "apps/mjarm/options.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/app.hpp"
#include "mjarm/core/messages/bench.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"

namespace mjarm::app {
namespace {

struct Options : BenchOptions {
  std::string tip;
};

Result<std::vector<PathRun>> run_ours(const PathProblem& problem, int rounds) {
  Progress progress(text(msg::bench_path_progress, problem.name),
                    problem.sets.size() * static_cast<std::uint64_t>(rounds));
  std::vector<PathRun> runs;
  for (const PathSet& set : problem.sets) {
    std::optional<PathRun> run = run_path(problem, set, rounds, [&] {
      progress.advance();
      return !interrupted();
    });
    if (!run) return fail(Errc::system, text(msg::app_interrupted));
    runs.push_back(std::move(*run));
  }
  return runs;
}

/// Paths of mjarm that it calls whole and that are not.
int wrong_paths(const PathRun& run) {
  return static_cast<int>(
      std::count_if(run.paths.begin(), run.paths.end(), [](const FollowedPath& path) {
        return path.off > 0 || (path.cause.empty() && !path.complete);
      }));
}

Result<BenchResult> measure(const Options& options, const std::string& robot, int rounds) {
  const auto problem = load_path_problem({.robot = robot, .tip = options.tip}, options.data);
  if (!problem) return fail(problem.error());
  Result<std::vector<PathRun>> runs = run_ours(*problem, rounds);
  if (!runs) return fail(std::move(runs.error()));
  if (!options.peers.empty()) {
    log_info(text(msg::bench_running_peers, problem->name));
    Result<std::vector<PathRun>> peers = run_path_peers(*problem, options.peers, rounds);
    if (!peers) return fail(std::move(peers.error()));
    runs->insert(runs->end(), peers->begin(), peers->end());
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
  auto options = std::make_shared<Options>();
  CLI::App& app = add_subcommand(bench, "path", msg::bench_path_summary, msg::bench_path_examples);
  add_bench_options(app, *options, msg::bench_path_option_data);
  add_option(app, "--tip", options->tip, msg::app_option_tip, "FRAME");
  return {&app, [options] {
            return run_suite(*options, {"ur5e", "panda"}, path_columns(),
                             [&](const std::string& robot, int rounds) {
                               return measure(*options, robot, rounds);
                             });
          }};
}

}  // namespace mjarm::app
