#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/rl.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/render/fonts.hpp"
#include "mjarm/render/plot.hpp"

namespace mjarm::app {
namespace {

/// When a policy counts as good: so many of the unseen goals within this distance.
struct Mark {
  double distance;  ///< [m]
  double share;
  const char* name;  ///< of the JSON member
  Msg heading;
};
constexpr Mark kMarks[] = {{0.02, 0.95, "2cm", msg::bench_rl_mark_2cm},
                           {0.01, 0.95, "1cm", msg::bench_rl_mark_1cm},
                           {0.005, 0.90, "5mm", msg::bench_rl_mark_5mm}};

/// Share of the goals, 0 to 1, that ended within `distance` [m].
double share_within(const LearningPoint& point, double distance) {
  const auto count = std::count_if(point.distances.begin(), point.distances.end(),
                                   [&](double d) { return d <= distance; });
  return static_cast<double>(count) / static_cast<double>(point.distances.size());
}

/// The first time that the mark was passed.
const LearningPoint* passed(const LearningRun& run, const Mark& mark) {
  for (const LearningPoint& point : run.curve) {
    if (share_within(point, mark.distance) >= mark.share) return &point;
  }
  return nullptr;
}

double middle(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

/// The runs of one learner on one set.
using Seeds = std::vector<const LearningRun*>;

/// When the seeds passed one mark.
struct Passing {
  std::vector<double> steps, seconds;
};
Passing passing_of(const Seeds& seeds, const Mark& mark) {
  Passing all;
  for (const LearningRun* run : seeds) {
    const LearningPoint* point = passed(*run, mark);
    if (point == nullptr) continue;
    all.steps.push_back(static_cast<double>(point->steps));
    all.seconds.push_back(point->seconds);
  }
  return all;
}

std::string in_cell(const Passing& passing, std::size_t seeds, bool timing) {
  if (passing.steps.empty()) return text(msg::bench_rl_never, seeds);
  const double thousands = 1e-3 * middle(passing.steps);
  if (!timing) return text(msg::bench_rl_passed, passing.steps.size(), seeds, thousands);
  const double worst = *std::max_element(passing.seconds.begin(), passing.seconds.end());
  return text(msg::bench_rl_passed_in, passing.steps.size(), seeds, thousands,
              middle(passing.seconds), worst);
}

/// Share of all goals of all seeds that the last policies reach.
double share_in_the_end(const Seeds& seeds, double distance) {
  double sum = 0;
  for (const LearningRun* run : seeds) sum += share_within(run->curve.back(), distance);
  return sum / static_cast<double>(seeds.size());
}

JsonDoc curve_json(const LearningRun& run, bool timing) {
  std::vector<JsonDoc> points;
  for (const LearningPoint& point : run.curve) {
    JsonDoc& doc = points.emplace_back();
    doc.set("steps", static_cast<std::size_t>(point.steps));
    if (timing) doc.set("seconds", point.seconds);
    for (const Mark& mark : kMarks) doc.set(mark.name, share_within(point, mark.distance));
    doc.set("median", middle(point.distances));
  }
  return {{"seed", static_cast<std::size_t>(run.seed)}, {"curve", std::move(points)}};
}

BenchEntry entry_of(const Seeds& seeds, bool timing) {
  const LearningRun& first = *seeds.front();
  BenchEntry entry{
      .who = first.who, .version = first.version, .set = first.set, .timed = first.timed};
  std::vector<double> rates;
  std::vector<JsonDoc> curves;
  for (const LearningRun* run : seeds) {
    entry.us.insert(entry.us.end(), run->us.begin(), run->us.end());
    for (const double us : run->us) rates.push_back(1e6 / us);
    curves.push_back(curve_json(*run, timing));
  }
  entry.cells.push_back(timing ? text(msg::bench_rl_rate, middle(rates)) : "-");
  JsonDoc marks, end;
  for (const Mark& mark : kMarks) {
    const Passing passing = passing_of(seeds, mark);
    entry.cells.push_back(in_cell(passing, seeds.size(), timing));
    JsonDoc doc{{"share", mark.share}, {"seeds", passing.steps.size()}, {"steps", passing.steps}};
    if (timing) doc.set("seconds", passing.seconds);
    marks.set(mark.name, std::move(doc));
    end.set(mark.name, share_in_the_end(seeds, mark.distance));
  }
  std::string last;
  for (const Mark& mark : kMarks) {
    const double share = 100 * share_in_the_end(seeds, mark.distance);
    last += (last.empty() ? "" : " / ") + text(msg::bench_rl_share, share);
  }
  entry.cells.push_back(last);
  entry.details = {{"seeds", seeds.size()},
                   {"reached", std::move(marks)},
                   {"in_the_end", std::move(end)},
                   {"runs", std::move(curves)}};
  if (timing) entry.details.set("rate", middle(rates));
  return entry;
}

/// One panel: the share within the distance of a mark, on one set.
render::PlotPanel panel_of(const std::vector<LearningRun>& runs, const std::string& set,
                           const Mark& mark, bool timing) {
  render::PlotPanel panel{.title = text(msg::bench_rl_panel, set, 1e3 * mark.distance),
                          .x_label = text(timing ? msg::bench_rl_seconds : msg::bench_rl_steps),
                          .y_label = text(msg::bench_rl_goals)};
  panel.y_range = render::PlotRange{0, 100};
  std::map<std::string, int> colors;
  for (const LearningRun& run : runs) {
    if (run.set != set || !run.error.empty()) continue;
    const auto [known, is_new] = colors.emplace(run.who, static_cast<int>(colors.size()));
    render::PlotLine line{.label = is_new ? run.who : std::string(), .color = known->second};
    for (const LearningPoint& point : run.curve) {
      line.x.push_back(timing ? point.seconds : 1e-3 * static_cast<double>(point.steps));
      line.y.push_back(100 * share_within(point, mark.distance));
    }
    panel.lines.push_back(std::move(line));
  }
  return panel;
}

}  // namespace

std::vector<Msg> learning_columns() {
  std::vector<Msg> columns{msg::bench_rl_column_rate};
  for (const Mark& mark : kMarks) columns.push_back(mark.heading);
  columns.push_back(msg::bench_rl_column_end);
  return columns;
}

std::vector<BenchEntry> learning_entries(const std::vector<LearningRun>& runs, bool timing) {
  std::vector<BenchEntry> entries;
  std::vector<Seeds> groups;  // in the order of their first run
  for (const LearningRun& run : runs) {
    if (!run.error.empty()) {
      entries.push_back(run);
      continue;
    }
    const auto group = std::ranges::find_if(groups, [&](const Seeds& seeds) {
      return seeds.front()->set == run.set && seeds.front()->who == run.who;
    });
    (group != groups.end() ? *group : groups.emplace_back()).push_back(&run);
  }
  for (const Seeds& seeds : groups) entries.push_back(entry_of(seeds, timing));
  return entries;
}

Result<void> draw_learning_curves(const std::vector<LearningRun>& runs, bool timing,
                                  const std::filesystem::path& folder) {
  const LanguageScope drawn(render::picture_language());
  render::Plot plot{.title = text(msg::bench_rl_title)};
  std::vector<std::string> sets;
  for (const LearningRun& run : runs) {
    // One point is no curve.
    if (run.curve.size() < 2 || std::find(sets.begin(), sets.end(), run.set) != sets.end()) {
      continue;
    }
    sets.push_back(run.set);
    for (const Mark& mark : kMarks) {
      plot.panels.push_back(panel_of(runs, run.set, mark, timing));
    }
  }
  if (plot.panels.empty()) return {};
  return render::save_plot(plot, folder / "curves");
}

}  // namespace mjarm::app
