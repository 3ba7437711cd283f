#include "apps/mjarm/commands/train_curve.hpp"

#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "apps/mjarm/cli/table.hpp"
#include "apps/mjarm/messages/train.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/render/fonts.hpp"

namespace mjarm::app {
namespace {

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t from = 0;; ++from) {
    const std::size_t to = line.find(',', from);
    cells.push_back(line.substr(from, to - from));
    if (to == std::string_view::npos) return cells;
    from = to;
  }
}

double value_of(std::string_view cell) {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return value;
}

/// A table of numbers with a heading; empty cells are NaN.
struct Columns {
  std::vector<std::string> names;
  std::vector<std::vector<double>> values;  ///< one vector a column

  [[nodiscard]] const std::vector<double>* find(std::string_view name) const {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] == name) return &values[i];
    }
    return nullptr;
  }
};

Columns read_columns(std::string_view csv) {
  Columns table;
  while (!csv.empty()) {
    const std::size_t end = csv.find('\n');
    const std::vector<std::string_view> cells = cells_of(csv.substr(0, end));
    csv = end == std::string_view::npos ? std::string_view() : csv.substr(end + 1);
    if (table.names.empty()) {
      table.names.assign(cells.begin(), cells.end());
      table.values.resize(cells.size());
    } else if (cells.size() == table.names.size()) {
      for (std::size_t i = 0; i < cells.size(); ++i) table.values[i].push_back(value_of(cells[i]));
    }
  }
  return table;
}

/// One column over the steps, without its gaps.
render::PlotLine line_of(const Columns& table, const char* name, double scale, std::string label) {
  render::PlotLine line{.label = std::move(label)};
  const auto *steps = table.find("step"), *values = table.find(name);
  for (std::size_t i = 0; steps && values && i < steps->size(); ++i) {
    if (!std::isfinite((*values)[i])) continue;
    line.x.push_back(1e-3 * (*steps)[i]);
    line.y.push_back(scale * (*values)[i]);
  }
  return line;
}

}  // namespace

std::string seeds_table(const std::vector<TrainedSeed>& runs) {
  std::vector<std::vector<std::string>> rows = {
      {text(msg::train_column_seed), text(msg::train_column_steps), text(msg::train_column_seconds),
       "5 cm", "2 cm", "1 cm", "5 mm", text(msg::train_column_median)}};
  for (const TrainedSeed& run : runs) {
    std::vector<std::string> row = {std::to_string(run.options.ppo.seed), std::to_string(run.steps),
                                    text(msg::train_count, run.seconds)};
    if (run.best) {
      for (const double share : {run.best->within_5cm, run.best->within_2cm, run.best->within_1cm,
                                 run.best->within_5mm}) {
        row.push_back(text(msg::train_percent, 100 * share));
      }
      row.push_back(text(msg::train_mm, 1e3 * run.best->median));
    }
    rows.push_back(std::move(row));
  }
  return markdown_table(rows);
}

Result<render::Plot> curve_plot(const std::filesystem::path& folder) {
  const Result<std::string> csv = read_file(folder / rl::Training::kProgress);
  if (!csv) return fail(csv.error());
  const Columns table = read_columns(*csv);
  render::PlotPanel success{.title = text(msg::train_plot_success),
                            .x_label = text(msg::train_plot_steps),
                            .y_label = text(msg::train_plot_share)};
  for (const auto& [name, label] :
       {std::pair{"within_5cm", "5 cm"}, std::pair{"within_2cm", "2 cm"},
        std::pair{"within_1cm", "1 cm"}, std::pair{"within_5mm", "5 mm"}}) {
    success.lines.push_back(line_of(table, name, 100, label));
  }
  success.y_range = render::PlotRange{0, 100};
  render::PlotPanel reward{.title = text(msg::train_plot_return),
                           .x_label = text(msg::train_plot_steps),
                           .y_label = text(msg::train_plot_return)};
  reward.lines.push_back(line_of(table, "mean_return", 1, {}));
  render::PlotPanel distance{.title = text(msg::train_plot_distance_over),
                             .x_label = text(msg::train_plot_steps),
                             .y_label = "mm"};
  distance.lines.push_back(line_of(table, "median", 1e3, text(msg::train_plot_median)));
  distance.lines.push_back(line_of(table, "p95", 1e3, "95 %"));
  distance.y_from_zero = true;
  render::PlotPanel spread{.title = text(msg::train_plot_std),
                           .x_label = text(msg::train_plot_steps),
                           .y_label = text(msg::train_plot_std)};
  spread.lines.push_back(line_of(table, "mean_std", 1, {}));
  spread.y_from_zero = true;
  return render::Plot{
      .title = text(msg::train_plot_title),
      .panels = {std::move(success), std::move(reward), std::move(distance), std::move(spread)}};
}

Result<void> draw_curve(const std::filesystem::path& folder) {
  const LanguageScope drawn(render::picture_language());
  return curve_plot(folder).and_then(
      [&folder](const render::Plot& plot) { return render::save_plot(plot, folder / "curve"); });
}

}  // namespace mjarm::app
