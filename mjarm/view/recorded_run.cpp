#include "mjarm/view/recorded_run.hpp"

#include <utility>

#include "mjarm/core/messages/view.hpp"

namespace mjarm::view {
namespace {

constexpr render::Rgba kInk = {0.45F, 0.45F, 0.48F, 1};  // on dark and on light

}  // namespace

LivePlot live_plot(const render::PlotPanel& panel) {
  LivePlot out{.title = panel.title,
               .x_label = panel.x_label,
               .series = {},
               .equal_aspect = panel.equal_aspect,
               .y_from_zero = panel.y_from_zero,
               .over_time = panel.over_time};
  if (!panel.y_label.empty() && panel.y_label != panel.title) {
    out.title = text(msg::view_plot_titled, panel.title, panel.y_label);
  }
  int next = 0;
  for (const render::PlotLine& line : panel.lines) {
    const bool dotted = line.style == render::LineStyle::dotted;
    LiveSeries series{.name = line.label,
                      .x = line.x,
                      .y = line.y,
                      .style = dotted ? render::LineStyle::dashed : line.style};
    series.color = line.color == render::PlotLine::kInk
                       ? kInk
                       : render::plot_color(line.color < 0 ? next++ : line.color);
    out.series.push_back(std::move(series));
  }
  return out;
}

}  // namespace mjarm::view
