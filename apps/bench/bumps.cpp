#include "apps/bench/bumps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "apps/bench/bump_world.hpp"
#include "apps/bench/messages/bench.hpp"
#include "apps/bench/robust_lap.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/table.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "mjarm/control/contact_observer.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/program.hpp"
#include "mjarm/render/plot.hpp"

namespace mjarm::app {
namespace {

constexpr int kMostBumps = 10'000, kMostQuietRuns = 10'000, kLastSeed = 1'000'000;
constexpr int kDrawsEach = 20;     // bumps that are drawn for one that joints can tell, at most
constexpr double kQuietRun = 120;  // [s] of motion in a world, without a bump
constexpr std::uint64_t kQuietWorlds = 1'000'000;  // their numbers begin here

/// Bumps of one kind.
struct BumpGroup {
  int bumps = 0, noticed = 0, right = 0, below = 0;
  std::vector<double> delays = {}, rests = {};  ///< [s]

  void add(const BumpRun& run) {
    ++bumps;
    noticed += run.delay && *run.delay <= kBumpTime ? 1 : 0;
    right += run.delay && run.named == run.link ? 1 : 0;
    below += run.delay && run.named == run.link - 1 ? 1 : 0;
    if (run.delay) delays.push_back(*run.delay);
    if (run.at_rest) rests.push_back(*run.at_rest);
  }
};

struct BumpResults {
  BumpGroup told = {}, untold = {};
  double hours = 0, surprise = 0;
  long alarms = 0;
  std::optional<BumpRun> slowest = {};
};

/// 0 where there are none.
double largest(const std::vector<double>& values) {
  return values.empty() ? 0 : std::ranges::max(values);
}

Result<BumpResults> drive_bumps(const Robot& robot, int count, int quiet, int seed) {
  const Result<Robot> known = known_robot(robot);
  if (!known) return fail(known.error());
  Progress progress(text(msg::control_suite_progress), static_cast<std::size_t>(count + quiet));
  BumpResults out;
  const auto drive = [&](std::uint64_t world, bool push) {
    return drive_bump(*known, robot, static_cast<std::uint64_t>(seed), world, push, kQuietRun);
  };
  for (int i = 0; out.told.bumps < count && i < kDrawsEach * count; ++i) {
    if (interrupted()) return fail(stopped());
    auto run = drive(static_cast<std::uint64_t>(i), true);
    if (!run) return fail(std::move(run.error()));
    if (run->pushed) (run->told ? out.told : out.untold).add(*run);
    out.alarms += run->alarms;
    out.surprise = std::max(out.surprise, run->surprise);
    if (!run->told) continue;
    progress.advance();
    if (!out.slowest || run->delay.value_or(1) > out.slowest->delay.value_or(1)) {
      out.slowest = std::move(*run);
    }
  }
  for (int i = 0; i < quiet; ++i) {
    if (interrupted()) return fail(stopped());
    const auto run = drive(kQuietWorlds + static_cast<std::uint64_t>(i), false);
    if (!run) return fail(run.error());
    out.hours += run->seconds / 3600;
    out.alarms += run->alarms;
    out.surprise = std::max(out.surprise, run->surprise);
    progress.advance();
  }
  return out;
}

std::string pair_in_ms(const std::vector<double>& seconds) {
  return fmt::format("{:.0f}, {:.0f}", 1e3 * percentile(seconds, 50), 1e3 * largest(seconds));
}

std::string bump_table(const BumpResults& results) {
  std::vector<std::vector<std::string>> rows{
      {text(msg::control_suite_bumps), "N", text(msg::control_suite_noticed),
       text(msg::control_suite_delay), text(msg::control_suite_link),
       text(msg::control_suite_stopped)}};
  for (const auto& [name, group] : {std::pair(msg::control_suite_bump_told, &results.told),
                                    std::pair(msg::control_suite_bump_untold, &results.untold)}) {
    rows.push_back({text(name), std::to_string(group->bumps), std::to_string(group->noticed),
                    pair_in_ms(group->delays), fmt::format("{}, {}", group->right, group->below),
                    pair_in_ms(group->rests)});
  }
  return markdown_table(rows) + "\n" +
         markdown_table({{text(msg::control_suite_hours), text(msg::control_suite_alarms),
                          text(msg::control_suite_largest)},
                         {fmt::format("{:.2f}", results.hours), std::to_string(results.alarms),
                          fmt::format("{:.1f}", results.surprise)}});
}

JsonDoc group_doc(const BumpGroup& group) {
  return {{"bumps", group.bumps},
          {"noticed", group.noticed},
          {"delay_median", percentile(group.delays, 50)},
          {"delay_max", largest(group.delays)},
          {"link_right", group.right},
          {"link_one_below", group.below},
          {"at_rest_median", percentile(group.rests, 50)},
          {"at_rest_max", largest(group.rests)}};
}

render::PlotPanel bump_panel(const Msg& label, const BumpRun& run, double BumpMoment::* which) {
  render::PlotLine line;
  for (const BumpMoment& moment : run.moments) {
    line.x.push_back(moment.time);
    line.y.push_back(moment.*which);
  }
  return {.x_label = text(msg::control_suite_time), .y_label = text(label), .lines = {line}};
}

render::PlotPanel bump_joints(const Msg& label, const BumpRun& run,
                              std::vector<double> BumpMoment::* which) {
  render::PlotPanel panel{.x_label = text(msg::control_suite_time), .y_label = text(label)};
  for (std::size_t j = 0; j < (run.moments.front().*which).size(); ++j) {
    render::PlotLine line{.label = std::to_string(j + 1)};
    for (const BumpMoment& moment : run.moments) {
      line.x.push_back(moment.time);
      line.y.push_back((moment.*which)[j]);
    }
    panel.lines.push_back(std::move(line));
  }
  return panel;
}

render::Plot bump_plot(const BumpRun& run) {
  render::Plot plot{.columns = 1, .panel_width = 560, .panel_height = 150};
  render::PlotPanel surprise =
      bump_panel(msg::control_suite_bump_surprise, run, &BumpMoment::surprise);
  const double threshold = ContactOptions{}.surprise;
  surprise.lines.push_back({.x = {run.moments.front().time, run.moments.back().time},
                            .y = {threshold, threshold},
                            .style = render::LineStyle::dotted,
                            .color = render::PlotLine::kInk});
  // What comes after the notice would flatten what led to it.
  for (double& y : surprise.lines.front().y) y = std::min(y, 5 * threshold);
  plot.panels = {bump_panel(msg::control_suite_bump_force, run, &BumpMoment::force),
                 bump_joints(msg::control_suite_bump_torque, run, &BumpMoment::torque),
                 std::move(surprise),
                 bump_joints(msg::control_suite_bump_speed, run, &BumpMoment::speed)};
  return plot;
}

}  // namespace

void add_bump_options(CLI::App& app, BumpWords& words) {
  add_option(app, "--bump-count", words.count, msg::control_suite_option_bump_count, "N");
  add_option(app, "--quiet-runs", words.quiet_runs, msg::control_suite_option_quiet, "N");
}

Result<int> run_bumps(const ReportOptions& report, const BumpWords& words, const std::string& seed,
                      const std::string& plot, const Robot& robot) {
  const Result<int> count = parse_count("--bump-count", words.count, kMostBumps);
  if (!count) return fail(count.error());
  const Result<int> quiet = parse_count("--quiet-runs", words.quiet_runs, kMostQuietRuns, 0);
  if (!quiet) return fail(quiet.error());
  const Result<int> drawn = parse_count("--seed", seed, kLastSeed);
  if (!drawn) return fail(drawn.error());
  const auto results = drive_bumps(robot, *count, *quiet, *drawn);
  if (!results) return fail(results.error());
  const JsonDoc doc{{"model", robot.model.name()},
                    {"told", group_doc(results->told)},
                    {"untold", group_doc(results->untold)},
                    {"hours", results->hours},
                    {"false_alarms", static_cast<double>(results->alarms)},
                    {"surprise_max", results->surprise}};
  print_robot(report, robot, bump_table(*results), doc);
  if (plot.empty() || !results->slowest) return 0;
  if (auto saved = render::save_plot(bump_plot(*results->slowest), plot); !saved) {
    return fail(std::move(saved.error()));
  }
  return 0;
}

}  // namespace mjarm::app
