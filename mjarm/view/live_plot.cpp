#include "mjarm/view/live_plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>

#include "mjarm/view/figure_internal.hpp"

namespace mjarm {
namespace {

struct Range {
  double lower = std::numeric_limits<double>::infinity();
  double upper = -std::numeric_limits<double>::infinity();

  void add(double value) {
    if (!std::isfinite(value)) return;
    lower = std::min(lower, value);
    upper = std::max(upper, value);
  }
  /// A length that can be drawn, with a margin.
  void finish() {
    if (lower > upper) lower = upper = 0;
    const double middle = (lower + upper) / 2;
    const double least = std::max(1e-4, 1e-3 * std::abs(middle));
    widen(std::max(1.1 * (upper - lower), least));
  }
  void widen(double length) {
    const double middle = (lower + upper) / 2;
    lower = middle - length / 2;
    upper = middle + length / 2;
  }
  [[nodiscard]] double length() const { return upper - lower; }
};

template <std::size_t N>
void copy_text(char (&target)[N], std::string_view text) {
  const std::size_t count = std::min(text.size(), N - 1);
  std::memcpy(target, text.data(), count);
  target[count] = '\0';
}

void set_colors(mjvFigure& figure) {
  const auto set = [](float* target, std::initializer_list<float> values) {
    std::copy(values.begin(), values.end(), target);
  };
  set(figure.figurergba, {0.10F, 0.12F, 0.15F, 0.55F});
  set(figure.panergba, {0.10F, 0.12F, 0.15F, 0.35F});
  set(figure.legendrgba, {0.10F, 0.12F, 0.15F, 0.35F});
  set(figure.gridrgb, {0.40F, 0.43F, 0.47F});
  set(figure.textrgb, {0.95F, 0.95F, 0.95F});
  figure.linewidth = 2.5F;
  figure.gridwidth = 1;
}

/// Copies a curve, at most mjMAXLINEPNT points of it.
void copy_points(const LiveSeries& series, int line, mjvFigure& figure) {
  const std::size_t count = std::min(series.x.size(), series.y.size());
  const std::size_t stride = count / (mjMAXLINEPNT - 1) + 1;
  float* data = figure.linedata[line];
  int points = 0;
  const auto append = [&](std::size_t i) {
    if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) return;
    data[2 * points] = static_cast<float>(series.x[i]);
    data[2 * points + 1] = static_cast<float>(series.y[i]);
    ++points;
  };
  for (std::size_t i = 0; i + 1 < count; i += stride) append(i);
  if (count > 0) append(count - 1);
  figure.linepnt[line] = points;
}

}  // namespace

void fill_figure(const LivePlot& plot, double aspect, mjvFigure& figure) {
  mjv_defaultFigure(&figure);
  set_colors(figure);
  copy_text(figure.title, plot.title);
  copy_text(figure.xlabel, plot.x_label);
  copy_text(figure.xformat, "%.3g");
  copy_text(figure.yformat, "%.3g");
  copy_text(figure.minwidth, "-0.00");
  figure.flg_extend = 0;
  figure.flg_ticklabel[0] = figure.flg_ticklabel[1] = 1;
  figure.gridsize[0] = figure.gridsize[1] = 5;
  Range x;
  Range y;
  const int lines = static_cast<int>(std::min<std::size_t>(plot.series.size(), mjMAXLINE));
  for (int line = 0; line < lines; ++line) {
    const LiveSeries& series = plot.series[line];
    figure.flg_legend = figure.flg_legend != 0 || !series.name.empty();
    copy_text(figure.linename[line], series.name);
    const float rgb[3] = {series.color.r, series.color.g, series.color.b};
    std::copy(rgb, rgb + 3, figure.linergb[line]);
    copy_points(series, line, figure);
    for (const double value : series.x) x.add(value);
    for (const double value : series.y) y.add(value);
  }
  x.finish();
  y.finish();
  if (plot.equal_aspect) {
    const double unit = std::max(x.length() / aspect, y.length());
    x.widen(unit * aspect);
    y.widen(unit);
  }
  figure.range[0][0] = static_cast<float>(x.lower);
  figure.range[0][1] = static_cast<float>(x.upper);
  figure.range[1][0] = static_cast<float>(y.lower);
  figure.range[1][1] = static_cast<float>(y.upper);
}

}  // namespace mjarm
