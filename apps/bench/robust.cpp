#include "apps/bench/robust.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "apps/bench/messages/bench.hpp"
#include "apps/mjarm/cli/table.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/program.hpp"

namespace mjarm::app {
namespace {

constexpr int kLateSteps = 2;  // 4 ms of the shipped robots

/// The gains with an integral are as high as the delay allows.
std::vector<RobustRun> robust_runs() {
  const RobustOptions late{.late_steps = kLateSteps};
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

}  // namespace

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

}  // namespace mjarm::app
