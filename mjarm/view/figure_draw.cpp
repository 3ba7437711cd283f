#include <algorithm>

#include "mjarm/view/figure_internal.hpp"

namespace mjarm::view {
namespace {

/// A strip of the figure's colour with a text in its middle.
void draw_strip(const std::string& text, const mjvFigure& figure, const mjrRect& strip,
                const TextTools& tools) {
  const float* ground = figure.figurergba;
  mjr_rectangle(strip, ground[0], ground[1], ground[2], ground[3]);
  const int left = strip.left + std::max(0, (strip.width - tools.width(text)) / 2);
  tools.draw(text, left, strip.bottom + (strip.height - tools.context.charHeight) / 2,
             figure.textrgb[0]);
}

/// The legend at the upper right, each name in the colour of its curve.
void draw_legend(const LivePlot& plot, const mjrRect& place, const TextTools& tools) {
  const int line = tools.line();
  int y = place.bottom + place.height - line;
  for (const LiveSeries& series : plot.series) {
    if (series.name.empty()) continue;
    const int width = tools.width(series.name);
    const float rgb[3] = {series.color.r, series.color.g, series.color.b};
    const PixelBox box{place.left + place.width - width - line, y -= line, width, line + 4};
    tools.font.draw(series.name, tools.window, box, rgb, width);
  }
}

}  // namespace

void draw_figure(const LivePlot& plot, mjvFigure& figure, mjrRect place, const TextTools& tools) {
  const int strip = tools.context.charHeight + tools.context.charHeight / 2;
  if (!is_ascii(plot.title)) {
    place.height -= strip;
    draw_strip(plot.title, figure, {place.left, place.bottom + place.height, place.width, strip},
               tools);
  }
  if (!is_ascii(plot.x_label)) {
    draw_strip(plot.x_label, figure, {place.left, place.bottom, place.width, strip}, tools);
    place.bottom += strip;
    place.height -= strip;
  }
  if (place.width <= 0 || place.height <= 0) return;
  mjr_figure(place, &figure, &tools.context);
  if (!std::ranges::all_of(plot.series, is_ascii, &LiveSeries::name)) {
    draw_legend(plot, place, tools);
  }
}

}  // namespace mjarm::view
