#include "apps/mjarm/commands/train_outcome.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "apps/mjarm/cli/table.hpp"
#include "apps/mjarm/messages/train.hpp"
#include "mjarm/core/units.hpp"

namespace mjarm::app {

std::string in_words(const rl::Evaluation& evaluation) {
  return text(msg::train_outcome, 100 * evaluation.within_5cm, 100 * evaluation.within_2cm,
              100 * evaluation.within_1cm, 100 * evaluation.within_5mm, 1e3 * evaluation.median);
}

int missed_of(const rl::Evaluation& evaluation) {
  return static_cast<int>(std::lround((1 - evaluation.within_2cm) * evaluation.episodes));
}

std::string evaluation_table(const rl::Evaluation& evaluation) {
  const auto row = [](Msg what, Msg value, double number) {
    return std::vector<std::string>{text(what), text(value, number)};
  };
  std::vector<std::vector<std::string>> rows = {
      row(msg::train_row_5cm, msg::train_percent, 100 * evaluation.within_5cm),
      row(msg::train_row_2cm, msg::train_percent, 100 * evaluation.within_2cm),
      row(msg::train_row_1cm, msg::train_percent, 100 * evaluation.within_1cm),
      row(msg::train_row_5mm, msg::train_percent, 100 * evaluation.within_5mm),
      row(msg::train_row_median, msg::train_mm, 1e3 * evaluation.median),
      row(msg::train_row_p95, msg::train_mm, 1e3 * evaluation.p95),
      row(msg::train_row_max, msg::train_mm, 1e3 * evaluation.max),
      row(msg::train_row_steps, msg::train_count, evaluation.steps),
      row(msg::train_row_steps_to_2cm, msg::train_count, evaluation.steps_to_2cm),
      row(msg::train_row_touched, msg::train_percent, 100 * evaluation.touched)};
  if (evaluation.turn_p95 > 0) {
    rows.push_back(
        row(msg::train_row_turn_median, msg::train_deg, kDegPerRad * evaluation.turn_median));
    rows.push_back(row(msg::train_row_turn_p95, msg::train_deg, kDegPerRad * evaluation.turn_p95));
  }
  return aligned(rows);
}

std::vector<Fact> facts_of(const rl::Evaluation& evaluation) {
  std::vector<Fact> facts = {
      {"success", evaluation.within_2cm},
      {"within", std::map<std::string, double>{{"5cm", evaluation.within_5cm},
                                               {"2cm", evaluation.within_2cm},
                                               {"1cm", evaluation.within_1cm},
                                               {"5mm", evaluation.within_5mm}}},
      {"episodes", static_cast<double>(evaluation.episodes)},
      {"distance",
       std::map<std::string, double>{
           {"median", evaluation.median}, {"p95", evaluation.p95}, {"max", evaluation.max}}},
      {"actions", evaluation.steps},
      {"actions_to_2cm", evaluation.steps_to_2cm},
      {"touched", evaluation.touched}};
  if (evaluation.turn_p95 > 0) {
    facts.push_back({"turn", std::map<std::string, double>{{"median", evaluation.turn_median},
                                                           {"p95", evaluation.turn_p95}}});
  }
  return facts;
}

render::PlotPanel distance_panel(const rl::Evaluation& evaluation) {
  render::PlotPanel panel{.title = text(msg::train_plot_distances),
                          .x_label = text(msg::train_plot_distance),
                          .y_label = text(msg::train_plot_share)};
  std::vector<double> sorted = evaluation.distances;
  std::ranges::sort(sorted);
  constexpr double kMax = 50;  // [mm]
  render::PlotLine line{.x = {0}, .y = {0}};
  const auto count = static_cast<double>(sorted.size());
  for (std::size_t i = 0; i < sorted.size() && 1e3 * sorted[i] <= kMax; ++i) {
    line.x.insert(line.x.end(), 2, 1e3 * sorted[i]);
    line.y.push_back(line.y.back());
    line.y.push_back(100 * static_cast<double>(i + 1) / count);
  }
  line.x.push_back(kMax);
  line.y.push_back(line.y.back());
  panel.lines.push_back(std::move(line));
  panel.x_range = render::PlotRange{0, kMax};
  panel.y_range = render::PlotRange{0, 100};
  return panel;
}

}  // namespace mjarm::app
