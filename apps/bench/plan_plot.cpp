#include "apps/bench/plan_plot.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "apps/bench/messages/bench_plan.hpp"
#include "mjarm/render/plot.hpp"

namespace mjarm::app {
namespace {

/// Steps up by one problem at each time that a valid path took.
render::PlotLine share_over_time(const render::PlotLine& style, std::vector<double> us,
                                 std::size_t problems) {
  render::PlotLine line = style;
  std::sort(us.begin(), us.end());
  for (std::size_t i = 0; i < us.size(); ++i) {
    line.x.push_back(std::log10(us[i]));
    line.y.push_back(100 * static_cast<double>(i + 1) / static_cast<double>(problems));
  }
  return line;
}

/// The contestants of a table in the order of their first run.
std::vector<std::string> contestants(const PlanTable& table) {
  std::vector<std::string> who;
  for (const PlanRun& run : table.runs) {
    if (!run.error.empty() || std::find(who.begin(), who.end(), run.who) != who.end()) continue;
    who.push_back(run.who);
  }
  return who;
}

render::PlotPanel panel_of(const PlanTable& table) {
  render::PlotPanel panel{.title = table.set->name,
                          .x_label = text(msg::bench_plan_time_axis),
                          .y_label = text(msg::bench_plan_share_axis)};
  panel.y_range = render::PlotRange{0, 100};
  int color = 0;
  for (const std::string& who : contestants(table)) {
    std::vector<double> us;
    std::size_t problems = 0;
    for (const PlanRun& run : table.runs) {
      if (run.who != who) continue;
      problems += run.answers.size();
      for (const SolvedProblem& answer : run.answers) {
        const bool valid = !answer.path.empty() && answer.verdict.fault == PathFault::none;
        if (valid) us.push_back(answer.us);
      }
    }
    panel.lines.push_back(share_over_time({.label = who, .color = color++}, us, problems));
  }
  return panel;
}

/// log10 of `value` of each crowd over log10 of its size: one line for boxes, one for points.
template <class Value>
render::PlotPanel panel_over_crowds(const std::vector<CrowdedSet>& crowds, Msg title, Msg axis,
                                    const Value& value) {
  render::PlotPanel panel{
      .title = text(title), .x_label = text(msg::bench_plan_count_axis), .y_label = text(axis)};
  render::PlotLine boxes{.label = text(msg::bench_plan_boxes)};
  render::PlotLine points{.label = text(msg::bench_plan_points)};
  for (std::size_t i = 0; i < crowds.size(); ++i) {
    render::PlotLine& line = crowds[i].points ? points : boxes;
    line.x.push_back(std::log10(static_cast<double>(crowds[i].obstacles)));
    line.y.push_back(std::log10(value(i)));
  }
  for (render::PlotLine* line : {&boxes, &points}) {
    if (!line->x.empty()) panel.lines.push_back(std::move(*line));
  }
  return panel;
}

double median_us(const PlanRun& run, bool world) {
  std::vector<double> us;
  for (const SolvedProblem& answer : run.answers) {
    us.push_back(world ? answer.world_us : answer.us - answer.world_us);
  }
  return times_of(us).median;
}

}  // namespace

Result<void> draw_plan_times(const std::vector<PlanTable>& sets,
                             const std::vector<CrowdedSet>& crowds, const PlanTable& crowded,
                             const std::filesystem::path& folder) {
  render::Plot plot{.title = text(msg::bench_plan_title)};
  for (const PlanTable& table : sets) plot.panels.push_back(panel_of(table));
  if (!crowds.empty()) {
    plot.panels.push_back(
        panel_over_crowds(crowds, msg::bench_plan_crowd_plan, msg::bench_plan_time_axis,
                          [&](std::size_t i) { return median_us(crowded.runs[i], false); }));
    plot.panels.push_back(
        panel_over_crowds(crowds, msg::bench_plan_crowd_world, msg::bench_plan_time_axis,
                          [&](std::size_t i) { return median_us(crowded.runs[i], true); }));
    plot.panels.push_back(
        panel_over_crowds(crowds, msg::bench_plan_crowd_check, msg::bench_plan_ns_axis,
                          [&](std::size_t i) { return crowded.checks[i].along_ns; }));
  }
  if (plot.panels.empty()) return {};
  return render::save_plot(plot, folder / "bench_plan");
}

}  // namespace mjarm::app
