#include <memory>
#include <utility>

#include "apps/bench/ik_peers.hpp"
#include "apps/bench/ik_report.hpp"
#include "apps/bench/messages/bench.hpp"
#include "apps/bench/suite.hpp"
#include "apps/bench/suites.hpp"

namespace mjarm::app {
namespace {

Result<std::vector<IkRun>> run_ours(const IkProblem& problem, int rounds) {
  const Advance advance = show_rounds(text(msg::bench_ik_progress, problem.name),
                                      static_cast<std::uint64_t>(ik_run_steps(problem, rounds)));
  auto runs = run_ik(problem, rounds, advance);
  if (!runs) return fail(stopped());
  return std::move(*runs);
}

Result<BenchResult> measure(const ToolBenchOptions& options, const std::string& robot, int rounds) {
  const auto problem = load_ik_problem({.robot = robot, .tip = options.tip}, options.data);
  if (!problem) return fail(problem.error());
  Result<std::vector<IkRun>> runs = run_ours(*problem, rounds);
  if (!runs) return fail(std::move(runs.error()));
  const auto run_peers = [&] { return run_ik_peers(*problem, options.peers, rounds); };
  if (auto added = add_peers(options, problem->name, *runs, run_peers); !added) {
    return fail(std::move(added.error()));
  }
  BenchResult result{problem->name, problem->robot.model.file().filename().string(), {}};
  int wrong = 0;
  for (IkRun& run : *runs) {
    if (Result<void> judged = judge(*problem, run); !judged) return fail(judged.error());
    wrong += run.version.empty() ? run.false_ok : 0;
    result.entries.push_back(ik_entry(run));
  }
  if (wrong > 0) result.wrong = text(msg::bench_ik_wrong, result.robot, wrong);
  return result;
}

}  // namespace

BenchSuite add_bench_ik(CLI::App& bench) {
  auto options = std::make_shared<ToolBenchOptions>();
  CLI::App& app = add_subcommand(bench, "ik", msg::bench_ik_summary, msg::bench_ik_examples);
  add_tool_bench_options(app, *options, msg::bench_ik_option_data);
  return {&app, [options] {
            return run_suite(*options, {"ur5e", "panda"}, ik_columns(),
                             [&](const std::string& robot, int rounds) {
                               return measure(*options, robot, rounds);
                             });
          }};
}

}  // namespace mjarm::app
