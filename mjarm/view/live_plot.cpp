#include "mjarm/view/live_plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>

#include "mjarm/view/figure_internal.hpp"

namespace mjarm {
namespace {

constexpr int kIntervals = 4;  ///< grid cells along an axis

/// The smallest of 1, 2, 2.5, 5 times a power of ten that is not below `least`.
double nice_step(double least) {
  const double unit = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 2.5, 5.0}) {
    if (factor * unit >= least * (1 - 1e-9)) return factor * unit;
  }
  return 10 * unit;
}

/// The part of an axis that shows all values seen, from one round number to another.
class Range {
 public:
  void add(double value) {
    if (!std::isfinite(value)) return;
    seen_lower_ = std::min(seen_lower_, value);
    seen_upper_ = std::max(seen_upper_, value);
  }
  /// The smallest round step with which the intervals cover all; 0 seen counts as one point.
  [[nodiscard]] double step() {
    if (seen_lower_ > seen_upper_) seen_lower_ = seen_upper_ = 0;
    const double largest = std::max(std::abs(seen_lower_), std::abs(seen_upper_));
    const double least = std::max(1e-4, 1e-3 * largest);
    double found = nice_step(std::max(seen_upper_ - seen_lower_, least) / kIntervals);
    while (lower(found) + kIntervals * found < seen_upper_) found = nice_step(1.01 * found);
    return found;
  }
  /// Where an axis of that step begins.
  [[nodiscard]] double lower(double step) const {
    return step * std::floor(seen_lower_ / step + 1e-9);
  }

 private:
  double seen_lower_ = std::numeric_limits<double>::infinity();
  double seen_upper_ = -std::numeric_limits<double>::infinity();
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

void fill_figure(const LivePlot& plot, mjvFigure& figure) {
  mjv_defaultFigure(&figure);
  set_colors(figure);
  copy_text(figure.title, plot.title);
  copy_text(figure.xlabel, plot.x_label);
  copy_text(figure.xformat, "%.4g");
  copy_text(figure.yformat, "%.4g");
  copy_text(figure.minwidth, "-0.00");
  figure.flg_extend = 0;
  figure.flg_ticklabel[0] = figure.flg_ticklabel[1] = 1;
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
  double steps[2] = {x.step(), y.step()};
  if (plot.equal_aspect) steps[0] = steps[1] = std::max(steps[0], steps[1]);
  const double lower[2] = {x.lower(steps[0]), y.lower(steps[1])};
  for (int i = 0; i < 2; ++i) {
    figure.gridsize[i] = kIntervals + 1;
    figure.range[i][0] = static_cast<float>(lower[i]);
    figure.range[i][1] = static_cast<float>(lower[i] + kIntervals * steps[i]);
  }
}

}  // namespace mjarm
