#include <memory>
#include <optional>
#include <utility>

#include "apps/mjarm/batch.hpp"
#include "apps/mjarm/bench/ik_peers.hpp"
#include "apps/mjarm/bench/ik_report.hpp"
#include "apps/mjarm/bench/suites.hpp"
#include "apps/mjarm/usage.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/app.hpp"
#include "mjarm/core/messages/bench.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"

namespace mjarm::app {
namespace {

constexpr std::uint64_t kMostRounds = 10'000;

struct Options {
  RobotOptions robot;
  std::string data, peers, rounds = "5", out;
  bool json = false, no_timing = false;
};

Result<std::vector<IkRun>> run_ours(const IkProblem& problem, int rounds) {
  Progress progress(text(msg::bench_ik_progress, problem.name),
                    static_cast<std::uint64_t>(ik_run_steps(problem, rounds)));
  auto runs = run_ik(problem, rounds, [&] {
    progress.advance();
    return !interrupted();
  });
  if (!runs) return fail(Errc::system, text(msg::app_interrupted));
  return std::move(*runs);
}

Result<IkResult> bench_robot(const Options& options, const std::string& robot, int rounds) {
  const auto problem = load_ik_problem({.robot = robot, .tip = options.robot.tip}, options.data);
  if (!problem) return fail(problem.error());
  Result<std::vector<IkRun>> runs = run_ours(*problem, rounds);
  if (!runs) return fail(std::move(runs.error()));
  if (!options.peers.empty()) {
    log_info(text(msg::bench_ik_running_peers, problem->name));
    Result<std::vector<IkRun>> peers = run_ik_peers(*problem, options.peers, rounds);
    if (!peers) return fail(std::move(peers.error()));
    runs->insert(runs->end(), peers->begin(), peers->end());
  }
  IkResult result{problem->name, problem->robot.model.file().filename().string(), {}};
  for (IkRun& run : *runs) {
    if (Result<void> judged = judge(*problem, run); !judged) return fail(judged.error());
  }
  result.runs = std::move(*runs);
  return result;
}

Result<int> run(const Options& options) {
  const Result<std::uint64_t> rounds = parse_whole("--rounds", options.rounds);
  if (!rounds) return fail(rounds.error());
  if (*rounds < 1 || *rounds > kMostRounds) {
    return fail(Errc::usage, text(msg::bench_ik_count, "--rounds", 1, kMostRounds, *rounds));
  }
  std::vector<std::string> robots{options.robot.robot};
  if (options.robot.robot.empty()) robots = {"ur5e", "panda"};
  std::vector<IkResult> results;
  for (const std::string& robot : robots) {
    Result<IkResult> result = bench_robot(options, robot, static_cast<int>(*rounds));
    if (!result) return fail(std::move(result.error()));
    results.push_back(std::move(*result));
  }
  const bool timing = !options.no_timing;
  std::string out = options.json ? ik_json(results, timing) : ik_table(results, timing);
  out.pop_back();  // the line break that is added now
  if (Result<void> written = write_answer(options.out, out); !written) {
    return fail(std::move(written.error()));
  }
  for (const IkResult& result : results) {
    int wrong = 0;
    for (const IkRun& run : result.runs) wrong += run.version.empty() ? run.false_ok : 0;
    if (wrong > 0) return fail(Errc::impossible, text(msg::bench_ik_wrong, result.robot, wrong));
  }
  return 0;
}

}  // namespace

BenchSuite add_bench_ik(CLI::App& bench) {
  auto options = std::make_shared<Options>();
  CLI::App& ik = add_subcommand(bench, "ik", msg::bench_ik_summary, msg::bench_ik_examples);
  ik.add_option("--robot", options->robot.robot, text(msg::bench_ik_option_robot))
      ->type_name("ROBOT");
  ik.add_option("--tip", options->robot.tip, text(msg::app_option_tip))->type_name("FRAME");
  ik.add_option("--data", options->data, text(msg::bench_ik_option_data))->type_name("DIR");
  ik.add_option("--peers", options->peers, text(msg::bench_ik_option_peers))->type_name("VENV");
  ik.add_option("--rounds", options->rounds, text(msg::bench_ik_option_rounds))->type_name("N");
  ik.add_option("--out", options->out, text(msg::bench_ik_option_out))->type_name("FILE");
  ik.add_flag("--json", options->json, text(msg::app_option_json));
  ik.add_flag("--no-timing", options->no_timing, text(msg::app_option_no_timing));
  return {&ik, [options] { return run(*options); }};
}

}  // namespace mjarm::app
