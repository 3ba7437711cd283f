#include "apps/bench/robust.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/robust_clearance.hpp"
#include "apps/bench/robust_lap.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/table.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/program.hpp"
#include "mjarm/render/plot.hpp"

namespace mjarm::app {
namespace {

constexpr int kMaxWorlds = 10'000, kMaxSeed = 1'000'000;
constexpr double kClearance = 0.003;  // [m] of the plan that is driven in wrong worlds

/// One way of control in wrong worlds.
struct RobustRun {
  std::string name;
  ControlMode mode = ControlMode::computed_torque;
  ControlOptions control = {};
  std::vector<RobustWorld> worlds = {};
  double timestep = 0;  ///< [s] of control
};

/// The gains with an integral are as high as the delay allows.
std::vector<RobustRun> robust_runs() {
  const RobustOptions late{.late_steps = kRobustLate};
  return {
      {"computed_torque", ControlMode::computed_torque, {.robust = late}},
      {"computed_torque, integral",
       ControlMode::computed_torque,
       {.stiffness = 1600, .damping = 80, .integral = 10000, .robust = late}},
      {"robust", ControlMode::robust, {.robust = late}},
  };
}

template <class Value>
Value largest(const RobustRun& run, Value RobustWorld::* which) {
  Value most = 0;
  for (const RobustWorld& world : run.worlds) most = std::max(most, world.*which);
  return most;
}

double mean_of_max(const RobustRun& run) {
  double sum = 0;
  for (const RobustWorld& world : run.worlds) sum += world.max;
  return sum / static_cast<double>(run.worlds.size());
}

std::string in_millimetres(double metres) { return fmt::format("{:.3f}", 1e3 * metres); }

Result<std::vector<RobustRun>> drive_wrong_worlds(const Robot& robot, int worlds, int seed) {
  const Result<RobustLaps> laps = robust_laps(robot);
  if (!laps) return fail(laps.error());
  std::vector<RobustRun> runs = robust_runs();
  Progress progress(text(msg::control_suite_progress),
                    runs.size() * static_cast<std::size_t>(worlds));
  for (RobustRun& run : runs) {
    run.timestep = robot.model.timestep();
    for (int i = 0; i < worlds; ++i) {
      if (interrupted()) return fail(stopped());
      auto done =
          drive_wrong_world(*laps, robot, run.mode, run.control, static_cast<std::uint64_t>(seed),
                            static_cast<std::uint64_t>(i));
      if (!done) return fail(std::move(done.error()));
      run.worlds.push_back(std::move(*done));
      progress.advance();
    }
  }
  return runs;
}

std::string robust_table(const std::vector<RobustRun>& runs) {
  std::vector<std::vector<std::string>> rows{
      {text(msg::control_suite_control), text(msg::control_suite_worlds), "max mm",
       text(msg::control_suite_mean_max), text(msg::control_suite_first_quarter),
       text(msg::control_suite_lag), text(msg::control_suite_ripple),
       text(msg::control_suite_at_rest), text(msg::control_suite_torque),
       text(msg::control_suite_cut), text(msg::control_suite_friction)}};
  for (const RobustRun& run : runs) {
    const bool learns = run.mode == ControlMode::robust;
    rows.push_back(
        {run.name, std::to_string(run.worlds.size()),
         in_millimetres(largest(run, &RobustWorld::max)), in_millimetres(mean_of_max(run)),
         in_millimetres(largest(run, &RobustWorld::first_quarter)),
         in_millimetres(largest(run, &RobustWorld::lag)),
         in_millimetres(largest(run, &RobustWorld::ripple)),
         in_millimetres(largest(run, &RobustWorld::rest)),
         fmt::format("{:.0f} %", 100 * largest(run, &RobustWorld::torque_use)),
         std::to_string(largest(run, &RobustWorld::limited_steps)),
         learns ? fmt::format("{:.1f} %", 100 * largest(run, &RobustWorld::friction)) : "-"});
  }
  return markdown_table(rows);
}

std::vector<JsonDoc> robust_docs(const std::vector<RobustRun>& runs) {
  std::vector<JsonDoc> docs;
  for (const RobustRun& run : runs) {
    std::vector<JsonDoc> worlds;
    for (const RobustWorld& world : run.worlds) {
      worlds.push_back({{"max", world.max},
                        {"first_quarter", world.first_quarter},
                        {"lag", world.lag},
                        {"ripple", world.ripple},
                        {"rest", world.rest},
                        {"torque_use", world.torque_use},
                        {"limited_steps", static_cast<double>(world.limited_steps)},
                        {"friction_error", world.friction}});
    }
    docs.push_back({{"name", run.name},
                    {"control", name(run.mode)},
                    {"max", largest(run, &RobustWorld::max)},
                    {"worlds", std::move(worlds)}});
  }
  return docs;
}

std::string robust_table(const ClearanceResult& result) {
  return "\n" +
         markdown_table({{text(msg::control_suite_plan), text(msg::control_suite_worlds),
                          text(msg::control_suite_planned), text(msg::control_suite_tube),
                          text(msg::control_suite_contacts)},
                         {"wall.xml", std::to_string(result.worlds), in_millimetres(result.planned),
                          in_millimetres(result.tube), std::to_string(result.contacts)}});
}

JsonDoc robust_doc(const ClearanceResult& result) {
  return {{"worlds", result.worlds},
          {"planned", result.planned},
          {"tube", result.tube},
          {"contacts", result.contacts}};
}

/// Distance from the ellipse over time, of the world in which each was farthest from it.
render::Plot robust_plot(const std::vector<RobustRun>& runs) {
  render::Plot plot{.columns = 1, .panel_width = 560, .panel_height = 170};
  for (const RobustRun& run : runs) {
    if (run.worlds.empty()) continue;
    const RobustWorld& world = *std::ranges::max_element(run.worlds, {}, &RobustWorld::max);
    render::PlotLine line;
    for (std::size_t i = 0; i < world.error.size(); ++i) {
      line.x.push_back(static_cast<double>(i + 1) * run.timestep);
      line.y.push_back(1e3 * world.error[i]);
    }
    plot.panels.push_back({.title = run.name,
                           .x_label = text(msg::control_suite_time),
                           .y_label = text(msg::control_suite_distance),
                           .lines = {std::move(line)},
                           .y_from_zero = true});
  }
  return plot;
}

}  // namespace

void add_robust_options(CLI::App& app, RobustWords& words) {
  add_option(app, "--worlds", words.worlds, msg::control_suite_option_worlds, "N");
  add_option(app, "--clearance-worlds", words.clearance_worlds, msg::control_suite_option_clear,
             "N");
  add_option(app, "--seed", words.seed, msg::control_suite_option_seed, "N");
  add_option(app, "--plot", words.plot, msg::control_suite_option_plot, "STEM");
}

Result<int> run_robust(const ReportOptions& report, const RobustWords& words, const Robot& robot) {
  const Result<int> worlds = parse_count("--worlds", words.worlds, kMaxWorlds);
  if (!worlds) return fail(worlds.error());
  const Result<int> clear = parse_count("--clearance-worlds", words.clearance_worlds, kMaxWorlds);
  if (!clear) return fail(clear.error());
  const Result<int> seed = parse_count("--seed", words.seed, kMaxSeed);
  if (!seed) return fail(seed.error());
  const auto runs = drive_wrong_worlds(robot, *worlds, *seed);
  if (!runs) return fail(runs.error());
  const auto clearance = clearance_in_wrong_worlds(kClearance, *clear, *seed);
  if (!clearance) return fail(clearance.error());
  const JsonDoc doc{{"model", robot.model.name()},
                    {"robust", robust_docs(*runs)},
                    {"clearance", robust_doc(*clearance)}};
  print_robot(report, robot, robust_table(*runs) + robust_table(*clearance), doc);
  if (words.plot.empty()) return 0;
  if (auto saved = render::save_plot(robust_plot(*runs), words.plot); !saved) {
    return fail(std::move(saved.error()));
  }
  return 0;
}

}  // namespace mjarm::app
