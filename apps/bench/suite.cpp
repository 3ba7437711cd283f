#include "apps/bench/suite.hpp"

#include <memory>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/mjarm/cli/batch.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"

namespace mjarm::app {

void add_bench_options(CLI::App& app, BenchOptions& options, Msg data_help) {
  const auto add = [&app](const char* name, std::string& value, Msg help, const char* type) {
    add_option(app, name, value, help, type);
  };
  add("--robot", options.robot, msg::bench_option_robot, "ROBOT");
  add("--data", options.data, data_help, "DIR");
  add("--peers", options.peers, msg::bench_option_peers, "VENV");
  add("--rounds", options.rounds, msg::bench_option_rounds, "N");
  add("--out", options.out, msg::bench_option_out, "FILE");
  add_flag(app, "--json", options.json, msg::app_option_json);
  add_flag(app, "--no-timing", options.no_timing, msg::app_option_no_timing);
}

void add_tool_bench_options(CLI::App& app, ToolBenchOptions& options, Msg data_help) {
  add_bench_options(app, options, data_help);
  add_option(app, "--tip", options.tip, msg::app_option_tip, "FRAME");
}

Advance show_rounds(const std::string& label, std::uint64_t rounds) {
  return [progress = std::make_shared<Progress>(label, rounds)] {
    progress->advance();
    return !interrupted();
  };
}

Error stopped() { return {Errc::system, text(msg::app_interrupted)}; }

bool wants_peers(const BenchOptions& options, const std::string& robot) {
  if (options.peers.empty()) return false;
  log_info(text(msg::bench_running_peers, robot));
  return true;
}

Result<int> run_suite(const BenchOptions& options, const std::vector<std::string>& robots,
                      const std::vector<Msg>& columns, const BenchRobot& measure) {
  constexpr int kMaxRounds = 10'000;
  const Result<int> rounds = parse_count("--rounds", options.rounds, kMaxRounds);
  if (!rounds) return fail(rounds.error());
  std::vector<std::string> asked{options.robot};
  if (options.robot.empty()) asked = robots;
  std::vector<BenchResult> results;
  for (const std::string& robot : asked) {
    Result<BenchResult> result = measure(robot, *rounds);
    if (!result) return fail(std::move(result.error()));
    results.push_back(std::move(*result));
  }
  const bool timing = !options.no_timing;
  std::string out =
      options.json ? bench_json(results, timing) : bench_table(results, columns, timing);
  out.pop_back();  // the line break that is added now
  if (Result<void> written = write_answer(options.out, out); !written) {
    return fail(std::move(written.error()));
  }
  for (const BenchResult& result : results) {
    if (!result.wrong.empty()) return fail(Errc::impossible, result.wrong);
  }
  return 0;
}

}  // namespace mjarm::app
