#include "mjarm/view/live_plot.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "mjarm/render/polyline.hpp"
#include "mjarm/view/figure_internal.hpp"

namespace mjarm::view {
namespace {

constexpr int kIntervals = 4;  ///< most grid cells along an axis

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
  /// @param coarse  for the y axis, both of whose ends MuJoCo moves outwards to multiples of the
  ///                power of ten in its length: they must be such from the start, or the grid is
  ///                uneven.
  explicit Range(bool coarse) : coarse_(coarse) {}
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
    while (lower(found) + kIntervals * found < seen_upper_ - 1e-9 * found) {
      found = nice_step(1.01 * found);
    }
    return found;
  }
  /// So many steps show all.
  [[nodiscard]] int intervals(double step) const {
    if (coarse_) return kIntervals;
    const double count = std::ceil((seen_upper_ - lower(step)) / step - 1e-9);
    return static_cast<int>(std::clamp(count, 1.0, static_cast<double>(kIntervals)));
  }
  /// Where an axis of that step begins.
  [[nodiscard]] double lower(double step) const {
    const double ten = std::pow(10.0, std::floor(std::log10(kIntervals * step) + 1e-9));
    const double unit = coarse_ ? ten : step;
    return unit * std::floor(seen_lower_ / unit + 1e-9);
  }

 private:
  bool coarse_;
  double seen_lower_ = std::numeric_limits<double>::infinity();
  double seen_upper_ = -std::numeric_limits<double>::infinity();
};

template <std::size_t N>
void copy_text(char (&target)[N], std::string_view text) {
  if (!is_ascii(text)) text = {};
  target[text.copy(target, N - 1)] = '\0';
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

/// What is drawn of a curve: its points, thinned to what a figure holds, in parts between gaps.
std::vector<std::vector<Eigen::Vector3d>> parts_of(const LiveSeries& series) {
  const std::size_t count = std::min(series.x.size(), series.y.size());
  const std::size_t stride = count / (mjMAXLINEPNT - 1) + 1;
  std::vector<std::vector<Eigen::Vector3d>> parts(1);
  const auto append = [&](std::size_t i) {
    if (std::isfinite(series.x[i]) && std::isfinite(series.y[i])) {
      parts.back().emplace_back(series.x[i], series.y[i], 0);
    } else if (!parts.back().empty()) {
      parts.emplace_back();
    }
  };
  for (std::size_t i = 0; i + 1 < count; i += stride) append(i);
  if (count > 0) append(count - 1);
  if (parts.back().empty()) parts.pop_back();
  return parts;
}

/// Puts points into the lines of a figure, one curve after the other.
class Pen {
 public:
  /// @param apart  points are ends of separate pieces, two each.
  /// @param legend  the figure's own.
  Pen(mjvFigure& figure, bool apart, bool legend) : figure_(figure), legend_(legend) {
    figure.flg_barplot = apart ? 1 : 0;
  }
  /// @return false where no line is left.
  bool begin(const LiveSeries& series) {
    name_ = series.name;
    color_ = series.color;
    return next_line();
  }
  void add(const Eigen::Vector3d& point) {
    int& points = figure_.linepnt[line_];
    figure_.linedata[line_][2 * points] = static_cast<float>(point.x());
    figure_.linedata[line_][2 * points + 1] = static_cast<float>(point.y());
    ++points;
  }
  void add_piece(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    // What one line of the figure does not hold goes on in the next, which has no name.
    if (figure_.linepnt[line_] + 2 > mjMAXLINEPNT && !next_line()) return;
    add(from);
    add(to);
  }

 private:
  bool next_line() {
    if (line_ + 1 == mjMAXLINE) return false;
    ++line_;
    copy_text(figure_.linename[line_], legend_ ? std::exchange(name_, {}) : std::string());
    figure_.flg_legend = figure_.flg_legend != 0 || figure_.linename[line_][0] != '\0';
    const float rgb[3] = {color_.r, color_.g, color_.b};
    std::copy(rgb, rgb + 3, figure_.linergb[line_]);
    return true;
  }
  mjvFigure& figure_;
  bool legend_;
  int line_ = -1;
  std::string name_;
  render::Rgba color_;
};

void draw_pieces(const LiveSeries& series, std::vector<Eigen::Vector3d> part,
                 const mjvFigure& figure, Pen& pen) {
  if (series.style == render::LineStyle::solid) {
    for (std::size_t i = 1; i < part.size(); ++i) pen.add_piece(part[i - 1], part[i]);
    return;
  }
  // Dashes are equally long on the screen, so they are cut in shares of the axes.
  const Eigen::Vector3d origin(figure.range[0][0], figure.range[1][0], 0);
  const Eigen::Vector3d size(figure.range[0][1] - figure.range[0][0],
                             figure.range[1][1] - figure.range[1][0], 1);
  for (Eigen::Vector3d& point : part) point = (point - origin).cwiseQuotient(size);
  const bool dashed = series.style == render::LineStyle::dashed;
  const std::vector<Eigen::Vector3d> ends =
      render::dashes(part, dashed ? 0.025 : 0.006, dashed ? 0.015 : 0.012);
  for (std::size_t i = 1; i < ends.size(); i += 2) {
    pen.add_piece(origin + ends[i - 1].cwiseProduct(size), origin + ends[i].cwiseProduct(size));
  }
}

/// Axes that show all of the curves.
void set_ranges(const LivePlot& plot, mjvFigure& figure) {
  Range axes[2] = {Range(false), Range(true)};
  for (const LiveSeries& series : plot.series) {
    for (const double value : series.x) axes[0].add(value);
    for (const double value : series.y) axes[1].add(value);
  }
  if (plot.y_from_zero) axes[1].add(0);
  double steps[2] = {axes[0].step(), axes[1].step()};
  if (plot.equal_aspect) steps[0] = steps[1] = std::max(steps[0], steps[1]);
  for (int i = 0; i < 2; ++i) {
    const double lower = axes[i].lower(steps[i]);
    const int intervals = plot.equal_aspect ? kIntervals : axes[i].intervals(steps[i]);
    figure.gridsize[i] = intervals + 1;
    figure.range[i][0] = static_cast<float>(lower);
    figure.range[i][1] = static_cast<float>(lower + intervals * steps[i]);
  }
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
  set_ranges(plot, figure);
  std::vector<std::vector<std::vector<Eigen::Vector3d>>> curves;
  bool apart = false;
  for (const LiveSeries& series : plot.series) {
    curves.push_back(parts_of(series));
    apart = apart || series.style != render::LineStyle::solid || curves.back().size() > 1;
  }
  const bool legend = std::ranges::all_of(plot.series, is_ascii, &LiveSeries::name);
  Pen pen(figure, apart, legend);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (!pen.begin(plot.series[i])) return;
    for (std::vector<Eigen::Vector3d>& part : curves[i]) {
      if (apart) {
        draw_pieces(plot.series[i], std::move(part), figure, pen);
      } else {
        for (const Eigen::Vector3d& point : part) pen.add(point);
      }
    }
  }
}

}  // namespace mjarm::view
