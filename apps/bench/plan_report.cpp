#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/plan.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/render/fonts.hpp"
#include "mjarm/render/plot.hpp"

namespace mjarm::app {
namespace {

std::vector<double> times_in(const PlanRun& run, double SolvedProblem::* time) {
  std::vector<double> us;
  for (const SolvedProblem& answer : run.answers) us.push_back(answer.*time);
  return us;
}

/// The median of a contestant over that of ours on the same problems; 0 where ours did none.
double ratio_to(const PlanRun& run, const PlanRun* ours) {
  if (ours == nullptr) return 0;
  std::map<std::size_t, double> known;
  for (const SolvedProblem& answer : ours->answers) known.emplace(answer.problem, answer.us);
  std::vector<double> theirs, mine;
  for (const SolvedProblem& answer : run.answers) {
    const auto same = known.find(answer.problem);
    if (same == known.end()) continue;
    theirs.push_back(answer.us);
    mine.push_back(same->second);
  }
  const double us = percentile(mine, 50);
  return us > 0 ? percentile(theirs, 50) / us : 0;
}

/// What the judge said of all paths.
struct Verdicts {
  int solved = 0, valid = 0;
  double cost = 0;  ///< mean of the valid ones
  std::vector<const SolvedProblem*> wrong;
};
Verdicts verdicts_of(const PlanRun& run) {
  Verdicts all;
  for (const SolvedProblem& answer : run.answers) {
    if (answer.path.empty()) continue;
    ++all.solved;
    if (answer.valid()) {
      ++all.valid;
      all.cost += answer.verdict.cost;
    } else {
      all.wrong.push_back(&answer);
    }
  }
  all.cost /= std::max(all.valid, 1);
  return all;
}

std::string or_dash(double value) { return value > 0 ? rounded(value) : "-"; }

void add_times(BenchEntry& entry, const PlanRun& run, const CheckTimes* checks) {
  const double p95 = percentile(entry.us, 95);
  const double world = percentile(times_in(run, &SolvedProblem::world_us), 50);
  entry.cells.push_back(or_dash(p95));
  entry.cells.push_back(or_dash(world));
  entry.cells.push_back(checks ? fmt::format("{:.1f} / {:.1f} / {:.1f}", checks->random_ns,
                                             checks->together_ns, checks->along_ns)
                               : "-");
  entry.details.set("p95_us", p95);
  entry.details.set("max_us", entry.us.empty() ? 0.0 : std::ranges::max(entry.us));
  entry.details.set("world_us", world);
  if (checks == nullptr) return;
  entry.details.set("check_ns", {{"random", checks->random_ns},
                                 {"together", checks->together_ns},
                                 {"along", checks->along_ns}});
}

std::string id_of(const PlanTable& table, const SolvedProblem& answer) {
  return table.ids.empty() ? std::to_string(answer.problem) : table.ids[answer.problem];
}

std::vector<JsonDoc> wrong_json(const PlanTable& table, const Verdicts& all) {
  std::vector<JsonDoc> wrong;
  for (const SolvedProblem* answer : all.wrong) {
    wrong.push_back({{"problem", id_of(table, *answer)},
                     {"fault", name_of(answer->verdict.fault)},
                     {"depth", answer->verdict.depth}});
  }
  return wrong;
}

/// What is shown of a table besides its answers.
struct Shown {
  bool timing = false, motions = false;
};

BenchEntry entry_of(const PlanTable& table, const PlanRun& run, const PlanRun* ours,
                    const CheckTimes* checks, const Shown& shown) {
  BenchEntry entry = run;
  entry.us = times_in(run, &SolvedProblem::us);
  entry.ratio = ratio_to(run, ours);
  const std::size_t asked = run.answers.size();
  const Verdicts all = verdicts_of(run);
  const double share =
      static_cast<double>(all.valid) / static_cast<double>(std::max<std::size_t>(asked, 1));
  entry.cells = {fmt::format("{}/{}", all.solved, asked), fmt::format("{:.1f} %", 100 * share),
                 all.valid > 0 ? fmt::format("{:.3f}", all.cost) : "-"};
  entry.details = {{"problems", asked},
                   {"solved", all.solved},
                   {"valid", all.valid},
                   {"cost", all.cost},
                   {"wrong", wrong_json(table, all)}};
  if (shown.motions && table.motions) add_motions(run, ours, entry);
  if (shown.motions && !table.motions) entry.cells.insert(entry.cells.end(), 2, "-");
  if (shown.timing) add_times(entry, run, checks);
  return entry;
}

/// Ours on the same case.
const PlanRun* ours_beside(const std::vector<PlanRun>& runs, const std::string& set) {
  const auto found = std::ranges::find_if(runs, [&](const PlanRun& run) {
    return run.version.empty() && run.error.empty() && run.set == set;
  });
  return found == runs.end() ? nullptr : &*found;
}

/// All runs of each contestant as one, in the order of the first.
std::vector<PlanRun> sums_of(const std::vector<PlanRun>& runs) {
  std::vector<PlanRun> sums;
  for (const PlanRun& run : runs) {
    if (!run.error.empty()) continue;
    const auto sum = std::ranges::find(sums, run.who, &PlanRun::who);
    if (sum == sums.end()) {
      sums.push_back(run);
      sums.back().set = text(msg::bench_plan_all);
    } else {
      sum->answers.insert(sum->answers.end(), run.answers.begin(), run.answers.end());
    }
  }
  return sums;
}

bool is_told(const std::vector<BenchEntry>& entries, const BenchEntry& failed) {
  return std::any_of(entries.begin(), entries.end(), [&](const BenchEntry& entry) {
    return entry.who == failed.who && entry.error == failed.error;
  });
}

std::string file_name(std::string text) {
  for (char& c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return text;
}

/// Steps up by one problem at each time that a valid path took.
render::PlotLine share_over_time(const render::PlotLine& style, std::vector<double> us,
                                 std::size_t problems) {
  render::PlotLine line = style;
  std::sort(us.begin(), us.end());
  for (std::size_t i = 0; i < us.size(); ++i) {
    line.x.push_back(us[i]);
    line.y.push_back(100 * static_cast<double>(i + 1) / static_cast<double>(problems));
  }
  return line;
}

render::PlotPanel panel_of(const PlanTable& table) {
  render::PlotPanel panel{.title = table.name,
                          .x_label = text(msg::bench_plan_time_axis),
                          .y_label = text(msg::bench_plan_share_axis)};
  panel.y_range = render::PlotRange{0, 100};
  panel.x_log = true;
  int color = 0;
  for (const PlanRun& run : sums_of(table.runs)) {
    std::vector<double> us;
    for (const SolvedProblem& answer : run.answers) {
      if (answer.valid()) us.push_back(answer.us);
    }
    panel.lines.push_back(
        share_over_time({.label = run.who, .color = color++}, us, run.answers.size()));
  }
  return panel;
}

/// `value` of each crowd over its size, both by their ratios: one line for boxes, one for points.
template <class Value>
render::PlotPanel panel_over_crowds(const std::vector<CrowdedSet>& crowds, Msg title, Msg axis,
                                    const Value& value) {
  render::PlotPanel panel{
      .title = text(title), .x_label = text(msg::bench_plan_count_axis), .y_label = text(axis)};
  panel.x_log = panel.y_log = true;
  render::PlotLine boxes{.label = text(msg::bench_plan_boxes)};
  render::PlotLine points{.label = text(msg::bench_plan_points)};
  for (std::size_t i = 0; i < crowds.size(); ++i) {
    render::PlotLine& line = crowds[i].points ? points : boxes;
    line.x.push_back(static_cast<double>(crowds[i].obstacles));
    line.y.push_back(value(i));
  }
  for (render::PlotLine* line : {&boxes, &points}) {
    if (!line->x.empty()) panel.lines.push_back(std::move(*line));
  }
  return panel;
}

std::vector<BenchEntry> entries_of(const PlanTable& table, const Shown& shown) {
  std::vector<BenchEntry> entries;
  std::size_t at = 0;  // of the checks
  for (const PlanRun& run : table.runs) {
    if (!run.error.empty()) {
      if (!is_told(entries, run)) entries.push_back(run);
      continue;
    }
    const bool checked = !table.sum && run.version.empty() && at < table.checks.size();
    const CheckTimes* checks = checked ? &table.checks[at++] : nullptr;
    entries.push_back(entry_of(table, run, ours_beside(table.runs, run.set), checks, shown));
  }
  const std::vector<PlanRun> sums = table.sum ? sums_of(table.runs) : std::vector<PlanRun>();
  for (const PlanRun& sum : sums) {
    const bool checked = sum.version.empty() && !table.checks.empty();
    entries.push_back(entry_of(table, sum, ours_beside(sums, sum.set),
                               checked ? &table.checks.front() : nullptr, shown));
  }
  for (const PlanRun& run : table.more) {
    entries.push_back(entry_of(table, run, ours_beside(table.more, run.set), nullptr, shown));
  }
  return entries;
}

/// How many answers of mjarm are wrong.
std::size_t count_wrong(const PlanTable& table, const std::vector<PlanRun>& runs) {
  std::size_t count = 0;
  for (const PlanRun& run : runs) {
    if (!run.version.empty()) continue;
    const Verdicts all = verdicts_of(run);
    const auto solved = static_cast<std::size_t>(all.solved);
    count += all.wrong.size() + (table.complete ? run.answers.size() - solved : 0);
  }
  return count;
}

}  // namespace

PlanTable table_of(const PlanSet& set) {
  PlanTable table{.name = set.name, .file = set.file.filename().string()};
  for (const PlanProblem& problem : set.cases) table.ids.push_back(problem.id);
  return table;
}

std::vector<Msg> plan_columns(bool timing, bool motions) {
  std::vector<Msg> columns{msg::bench_plan_solved, msg::bench_plan_valid, msg::bench_plan_cost};
  if (motions) {
    columns.insert(columns.end(), {msg::bench_plan_motion, msg::bench_plan_motion_ratio});
  }
  if (!timing) return columns;
  columns.insert(columns.end(),
                 {msg::bench_plan_p95, msg::bench_plan_world, msg::bench_plan_check});
  return columns;
}

BenchResult plan_result(const std::string& name, const PlanTable& table, bool timing,
                        bool motions) {
  BenchResult result{name, table.file, entries_of(table, {timing, motions})};
  const std::size_t wrong = count_wrong(table, table.runs) + count_wrong(table, table.more);
  if (wrong > 0) result.wrong = text(msg::bench_plan_wrong, name, wrong);
  return result;
}

Result<void> write_paths(const PlanTable& table, bool timing, const std::filesystem::path& folder) {
  for (const PlanRun& sum : sums_of(table.runs)) {
    JsonDoc paths{std::initializer_list<JsonDoc::Member>{}};
    for (const SolvedProblem& answer : sum.answers) {
      if (answer.path.empty()) continue;
      JsonDoc path{{"path", answer.path}};
      if (timing) path.set("us", answer.us);
      paths.set(id_of(table, answer).c_str(), std::move(path));
    }
    const std::string name = "paths_" + file_name(table.name + " " + sum.who) + ".json";
    if (auto written = write_file(folder / name, paths.line() + "\n"); !written) {
      return fail(std::move(written.error()));
    }
  }
  return {};
}

Result<void> draw_plan_times(const std::vector<PlanTable>& sets,
                             const std::vector<CrowdedSet>& crowds, const PlanTable& crowded,
                             const std::filesystem::path& folder) {
  const LanguageScope drawn(render::picture_language());
  render::Plot plot{.title = text(msg::bench_plan_title)};
  for (const PlanTable& table : sets) plot.panels.push_back(panel_of(table));
  const auto add = [&](Msg title, Msg axis, const auto& value) {
    if (!crowds.empty()) plot.panels.push_back(panel_over_crowds(crowds, title, axis, value));
  };
  add(msg::bench_plan_crowd_plan, msg::bench_plan_time_axis, [&](std::size_t i) {
    std::vector<double> us;
    for (const auto& answer : crowded.runs[i].answers) us.push_back(answer.us - answer.world_us);
    return percentile(us, 50);
  });
  add(msg::bench_plan_crowd_world, msg::bench_plan_time_axis, [&](std::size_t i) {
    return percentile(times_in(crowded.runs[i], &SolvedProblem::world_us), 50);
  });
  add(msg::bench_plan_crowd_check, msg::bench_plan_ns_axis,
      [&](std::size_t i) { return crowded.checks[i].along_ns; });
  if (plot.panels.empty()) return {};
  return render::save_plot(plot, folder / "bench_plan");
}

}  // namespace mjarm::app
