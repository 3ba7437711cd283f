#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "apps/bench/control_trial.hpp"
#include "apps/bench/messages/control_suite.hpp"
#include "apps/bench/report.hpp"
#include "apps/bench/suite.hpp"
#include "apps/bench/suites.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/cli/table.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/messages/app.hpp"

namespace mjarm::app {
namespace {

struct Options {
  RobotChoice robot{.robot = "ur5e", .tip = {}};
  std::string poses = "100";
  bool json = false, no_timing = false;
};

constexpr ControlOptions kWithIntegral{.stiffness = 4800, .damping = 120, .integral = 64000};

/// A lap and what it was asked for.
struct LapRun {
  std::string name;
  LapOptions options;
  std::optional<double> acceleration_limit;  ///< [rad/s^2] raised for this one
  LapResult result = {};
};

std::vector<LapRun> laps() {
  std::vector<LapRun> out;
  for (const ControlMode mode : {ControlMode::servo, ControlMode::servo_gravity,
                                 ControlMode::feed_forward, ControlMode::computed_torque}) {
    LapOptions lap;
    lap.mode = mode;
    out.push_back({"10 s", lap, {}});
  }
  LapOptions fast;
  fast.seconds = 4;
  out.push_back({"4 s", fast, 15});
  LapOptions loaded;
  loaded.payload = 1;
  out.push_back({"10 s, 1 kg", loaded, {}});
  loaded.control = kWithIntegral;
  out.push_back({"10 s, 1 kg, integral", loaded, {}});
  return out;
}

struct RestRun {
  ControlMode mode;
  RestResult result;
};

std::string millimetres(double metres) { return fmt::format("{:.4g}", 1e3 * metres); }

std::string to_table(const std::vector<RestRun>& rests, const std::vector<LapRun>& runs,
                     bool timing) {
  std::vector<std::vector<std::string>> rows{
      {text(msg::control_suite_rest), text(msg::control_suite_poses), "mm", "deg"}};
  for (const RestRun& run : rests) {
    rows.push_back({std::string(name(run.mode)), std::to_string(run.result.poses),
                    millimetres(run.result.worst.position),
                    fmt::format("{:.3g}", run.result.worst.rotation * 180 / std::numbers::pi)});
  }
  std::string out = timing ? bench_occasion() + "\n\n" : std::string();
  out += markdown_table(rows) + "\n";
  rows = {{text(msg::control_suite_lap), text(msg::control_suite_control), "max mm", "rms mm",
           text(msg::control_suite_half), text(msg::control_suite_lag),
           text(msg::control_suite_covered), "m/s", "rad/s2", text(msg::control_suite_cut)}};
  if (timing) rows.front().emplace_back("rtf");
  for (const LapRun& run : runs) {
    const LapResult& lap = run.result;
    rows.push_back(
        {run.name, std::string(name(run.options.mode)), millimetres(lap.error.max),
         millimetres(lap.error.rms), millimetres(lap.second_half), millimetres(lap.lag),
         fmt::format("{:.1f} %", 100 * lap.error.coverage), fmt::format("{:.3f}", lap.peak_speed),
         fmt::format("{:.2f}", lap.peak_acceleration), std::to_string(lap.limited_steps)});
    if (timing) rows.back().push_back(fmt::format("{:.0f}", lap.rtf));
  }
  return out + markdown_table(rows);
}

JsonDoc to_json(const Robot& robot, const std::vector<RestRun>& rests,
                const std::vector<LapRun>& runs, bool timing) {
  std::vector<JsonDoc> rest_docs, lap_docs;
  for (const RestRun& run : rests) {
    rest_docs.push_back({{"control", std::string_view(name(run.mode))},
                         {"poses", run.result.poses},
                         {"position", run.result.worst.position},
                         {"rotation", run.result.worst.rotation}});
  }
  for (const LapRun& run : runs) {
    const LapResult& lap = run.result;
    JsonDoc doc{{"name", run.name},
                {"control", std::string_view(name(run.options.mode))},
                {"seconds", run.options.seconds},
                {"payload", run.options.payload},
                {"integral", run.options.control.integral},
                {"path_error_max", lap.error.max},
                {"path_error_rms", lap.error.rms},
                {"second_half_max", lap.second_half},
                {"lag_max", lap.lag},
                {"coverage", lap.error.coverage},
                {"peak_speed", lap.peak_speed},
                {"peak_acceleration", lap.peak_acceleration},
                {"velocity_use", lap.velocity_use},
                {"limited_steps", static_cast<double>(lap.limited_steps)}};
    if (timing) doc.set("rtf", lap.rtf);
    lap_docs.push_back(std::move(doc));
  }
  return {{"model", std::string_view(robot.model.name())},
          {"rest", std::move(rest_docs)},
          {"laps", std::move(lap_docs)}};
}

Result<int> run_control(const Options& options) {
  constexpr int kMaxPoses = 100'000;
  const Result<int> poses = parse_count("--poses", options.poses, kMaxPoses);
  if (!poses) return fail(poses.error());
  const Result<Robot> robot = load_robot(options.robot);
  if (!robot) return fail(robot.error());
  std::vector<LapRun> runs = laps();
  const ControlMode modes[] = {ControlMode::servo, ControlMode::servo_gravity,
                               ControlMode::feed_forward, ControlMode::computed_torque};
  const Advance advance =
      show_rounds(text(msg::control_suite_progress), std::size(modes) + runs.size());
  std::vector<RestRun> rests;
  for (const ControlMode mode : modes) {
    const auto rest = rest_errors(robot->model, robot->arm, mode, *poses);
    if (!rest) return fail(rest.error());
    rests.push_back({mode, *rest});
    if (!advance()) return fail(stopped());
  }
  for (LapRun& run : runs) {
    Arm arm = robot->arm;
    if (run.acceleration_limit) arm.limits.acceleration.setConstant(*run.acceleration_limit);
    const auto lap = drive_lap(robot->model, arm, run.options);
    if (!lap) return fail(lap.error());
    run.result = *lap;
    if (!advance()) return fail(stopped());
  }
  const bool timing = !options.no_timing;
  const std::string out = options.json ? to_json(*robot, rests, runs, timing).document()
                                       : to_table(rests, runs, timing);
  std::fputs(out.c_str(), stdout);
  return 0;
}

}  // namespace

BenchSuite add_bench_control(CLI::App& bench) {
  auto options = std::make_shared<Options>();
  CLI::App& app =
      add_subcommand(bench, "control", msg::control_suite_summary, msg::control_suite_examples);
  add_robot_options(app, options->robot);
  add_option(app, "--poses", options->poses, msg::control_suite_option_poses, "N");
  add_flag(app, "--json", options->json, msg::app_option_json);
  add_flag(app, "--no-timing", options->no_timing, msg::app_option_no_timing);
  return {&app, [options] { return run_control(*options); }};
}

}  // namespace mjarm::app
