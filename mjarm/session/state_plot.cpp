#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "mjarm/core/messages/run_charts.hpp"
#include "mjarm/core/messages/show.hpp"
#include "mjarm/session/chart_stride_internal.hpp"
#include "mjarm/session/model_run_output.hpp"

namespace mjarm::session {
namespace {

constexpr std::size_t kMaxCurves = 8;  // as many colours as can be told apart

/// One number of the log over time.
struct StateCurve {
  render::PlotLine line;
  double travel = 0;  ///< from its least to its largest value
  double size = 0;    ///< largest magnitude
};

StateCurve curve_of(const StateLog& log, std::size_t column, const std::string& label) {
  StateCurve curve{.line = {.label = label}};
  const std::size_t stride = chart_stride(log.size());
  for (std::size_t i = 0; i < log.size(); ++i) {
    if (i % stride != 0 && i + 1 != log.size()) continue;
    curve.line.x.push_back(log.row(i)[0]);
    curve.line.y.push_back(log.row(i)[column]);
  }
  const auto [least, largest] = std::ranges::minmax_element(curve.line.y);
  if (least != curve.line.y.end()) {
    curve.travel = *largest - *least;
    curve.size = std::max(std::abs(*least), std::abs(*largest));
  }
  return curve;
}

/// Keeps the curves that move most, in the order of the model.
void keep_the_liveliest(std::vector<StateCurve>& curves) {
  if (curves.size() <= kMaxCurves) return;
  std::vector<double> travels;
  for (const StateCurve& curve : curves) travels.push_back(curve.travel);
  std::ranges::sort(travels, std::greater<>());
  const double least = travels[kMaxCurves - 1];
  std::erase_if(curves, [least](const StateCurve& curve) { return curve.travel < least; });
  if (curves.size() > kMaxCurves) curves.resize(kMaxCurves);
}

/// The columns of one kind that have this unit, if there are any.
void add_panel(render::Plot& plot, const StateLog& log, const std::vector<StateColumn>& columns,
               std::size_t first, const char* unit, Msg title) {
  std::vector<StateCurve> curves;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (unit != nullptr && columns[i].unit != unit) continue;
    curves.push_back(curve_of(log, first + i, columns[i].name));
  }
  // Speeds of what stands still are noise.
  const bool speeds = unit != nullptr && std::string_view(unit).ends_with("/s");
  const double least = speeds ? 1e-9 : -1;
  if (std::ranges::none_of(curves, [least](const auto& curve) { return curve.size > least; })) {
    return;
  }
  keep_the_liveliest(curves);
  render::PlotPanel panel{.title = text(title), .x_label = text(msg::run_chart_time)};
  panel.over_time = true;
  panel.y_label = unit != nullptr ? unit : "";
  for (StateCurve& curve : curves) panel.lines.push_back(std::move(curve.line));
  plot.panels.push_back(std::move(panel));
}

}  // namespace

render::Plot state_plot(const std::string& title, const StateLog& log) {
  render::Plot plot{.title = title};
  const StateColumns& columns = log.columns();
  add_panel(plot, log, columns.qpos, log.qpos_at(), "rad", msg::show_plot_angles);
  add_panel(plot, log, columns.qpos, log.qpos_at(), "m", msg::show_plot_places);
  add_panel(plot, log, columns.qvel, log.qvel_at(), "rad/s", msg::show_plot_spins);
  add_panel(plot, log, columns.qvel, log.qvel_at(), "m/s", msg::show_plot_speeds);
  add_panel(plot, log, columns.ctrl, log.ctrl_at(), nullptr, msg::show_plot_ctrl);
  add_panel(plot, log, columns.sensors, log.sensor_at(), nullptr, msg::show_plot_sensors);
  return plot;
}

}  // namespace mjarm::session
