#include "mjarm/core/messages/sim.hpp"

#include <memory>

#include "apps/bench/suite.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "mjarm/sim/bench.hpp"

namespace mjarm::app {
namespace {

/// More than this takes hours.
constexpr int kMax = 1'000'000;

struct SimWords : ReportOptions {
  RobotChoice robot{.robot = "ur5e", .tip = {}};
  std::string rounds = "40", steps = "250";
};

std::string to_json(const Robot& robot, const SimBenchOptions& work,
                    const std::vector<SimBenchEntry>& entries, bool timing) {
  std::string out;
  JsonWriter json(out);
  json.object()
      .member("model", robot.model.name())
      .member("timestep", robot.model.timestep())
      .member("rounds", work.rounds)
      .member("steps", work.steps)
      .key("entries")
      .list();
  for (const SimBenchEntry& entry : entries) {
    json.object().member("name", entry.name);
    // The ratio is made of times as well, so it goes with them.
    if (timing) {
      json.member("us", entry.us).member("rtf", entry.rtf).member("ratio", entry.ratio);
    }
    json.end_object();
  }
  json.end_list().end_object();
  return out + '\n';
}

std::string to_table(const std::vector<SimBenchEntry>& entries, bool timing) {
  std::string out = text(msg::sim_bench_title) + '\n';
  for (const SimBenchEntry& entry : entries) {
    out += timing ? text(msg::sim_bench_row, entry.name, entry.us, entry.rtf, entry.ratio)
                  : entry.name;
    out += '\n';
  }
  return out;
}

Result<int> run_sim(const SimWords& options) {
  const Result<int> rounds = parse_count("--rounds", options.rounds, kMax);
  if (!rounds) return fail(rounds.error());
  const Result<int> steps = parse_count("--steps", options.steps, kMax);
  if (!steps) return fail(steps.error());
  const Result<Robot> robot = load_robot(options.robot);
  if (!robot) return fail(robot.error());
  const SimBenchOptions work{.rounds = *rounds, .steps = *steps};
  const auto entries = bench_sim(robot->model, robot->arm, work);
  if (!entries) return fail(entries.error());
  const bool timing = !options.no_timing;
  const std::string out =
      options.json ? to_json(*robot, work, *entries, timing) : to_table(*entries, timing);
  std::fwrite(out.data(), 1, out.size(), stdout);
  return 0;
}

}  // namespace

Command sim_suite() {
  return {"sim", msg::sim_bench_summary, msg::sim_bench_examples, [](CLI::App& app) -> Run {
            auto options = std::make_shared<SimWords>();
            add_robot_options(app, options->robot);
            add_option(app, "--steps", options->steps, msg::sim_bench_steps, "N");
            add_option(app, "--rounds", options->rounds, msg::sim_bench_rounds, "N");
            add_report_options(app, *options);
            return [options] { return run_sim(*options); };
          }};
}

}  // namespace mjarm::app
