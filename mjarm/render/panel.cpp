#include <algorithm>
#include <array>
#include <cmath>

#include "mjarm/render/field_internal.hpp"
#include "mjarm/render/panel_internal.hpp"

namespace mjarm::panel {
namespace {

using canvas::Align;
using canvas::Box;
using canvas::Page;
using canvas::Point;
using canvas::TextStyle;

/// Colours that readers with any common kind of colour blindness can tell apart: the set of Okabe
/// and Ito without its yellow, which is too pale for lines, and two of Paul Tol.
constexpr std::array<render::Rgba, 8> kPalette = {{{0.000F, 0.447F, 0.698F, 1},    // blue
                                                   {0.835F, 0.369F, 0.000F, 1},    // vermilion
                                                   {0.000F, 0.620F, 0.451F, 1},    // green
                                                   {0.800F, 0.475F, 0.655F, 1},    // pink
                                                   {0.902F, 0.624F, 0.000F, 1},    // orange
                                                   {0.337F, 0.706F, 0.914F, 1},    // sky
                                                   {0.533F, 0.133F, 0.333F, 1},    // wine
                                                   {0.600F, 0.600F, 0.200F, 1}}};  // olive
constexpr render::Rgba kInk = {0.20F, 0.20F, 0.20F, 1};
constexpr render::Rgba kAxis = {0.40F, 0.40F, 0.40F, 1};
constexpr render::Rgba kGrid = {0.90F, 0.90F, 0.90F, 1};
constexpr render::Rgba kBand = {0.00F, 0.62F, 0.45F, 0.13F};

constexpr TextStyle kTitle{.size = 9, .bold = true};
constexpr TextStyle kLabel{.size = 8, .align = Align::middle};
constexpr TextStyle kTick{.size = 7, .color = {0.3F, 0.3F, 0.3F, 1}};
constexpr TextStyle kLegend{.size = 7.5};
constexpr double kTickLength = 2.5;
constexpr double kSample = 16;        // length of a line in the legend
constexpr double kLegendHeight = 11;  // of one row
constexpr double kAwayFromText = 4;
constexpr double kMarginShare = 0.04;

/// Ranges and marks of an axis of logarithms are those of the logarithms.
struct Axes {
  Box box;
  render::PlotRange x;
  render::PlotRange y;
  bool x_log = false;
  bool y_log = false;

  [[nodiscard]] double mark_x(double at) const {
    return box.x + (at - x.lower) / (x.upper - x.lower) * box.width;
  }
  [[nodiscard]] double mark_y(double at) const {
    return box.y + box.height - (at - y.lower) / (y.upper - y.lower) * box.height;
  }
  [[nodiscard]] double to_x(double value) const {
    return mark_x(x_log ? std::log10(value) : value);
  }
  [[nodiscard]] double to_y(double value) const {
    return mark_y(y_log ? std::log10(value) : value);
  }
};

double on_axis(double value, bool log) { return log ? std::log10(value) : value; }

render::PlotRange on_axis(const render::PlotRange& range, bool log) {
  return {on_axis(range.lower, log), on_axis(range.upper, log)};
}

struct Entry {
  const render::PlotLine* line = nullptr;  ///< null for a band
  std::string label;
  render::Rgba color;
  double x = 0;  ///< from the left of the axes
  int row = 0;
};

TextStyle aligned(TextStyle style, Align align) {
  style.align = align;
  return style;
}

/// The colour of each line.
std::vector<render::Rgba> colors_of(const render::PlotPanel& panel) {
  std::vector<render::Rgba> colors;
  std::size_t next = 0;
  for (const render::PlotLine& line : panel.lines) {
    if (line.color == render::PlotLine::kInk) {
      colors.push_back(kInk);
    } else {
      const std::size_t index = line.color < 0 ? next++ : static_cast<std::size_t>(line.color);
      colors.push_back(render::plot_color(static_cast<int>(index)));
    }
  }
  return colors;
}

/// Legend entries in rows no wider than `width`.
std::vector<Entry> legend_of(const render::PlotPanel& panel, double width) {
  std::vector<Entry> entries;
  if (!panel.legend) return entries;
  const std::vector<render::Rgba> colors = colors_of(panel);
  for (std::size_t i = 0; i < panel.lines.size(); ++i) {
    if (panel.lines[i].label.empty()) continue;
    entries.push_back({&panel.lines[i], panel.lines[i].label, colors[i]});
  }
  for (const render::PlotBand& band : panel.bands) {
    if (!band.label.empty()) entries.push_back({nullptr, band.label, kBand});
  }
  double x = 0;
  int row = 0;
  for (Entry& entry : entries) {
    const double length = kSample + kAwayFromText + canvas::text_width(entry.label, kLegend);
    if (x > 0 && x + length > width) {
      x = 0;
      ++row;
    }
    entry.x = x;
    entry.row = row;
    x += length + 10;
  }
  return entries;
}

int rows_of(const std::vector<Entry>& legend) { return legend.empty() ? 0 : legend.back().row + 1; }

/// The ranges that show all that counts, before they are fitted to a box.
Axes ranges_of(const render::PlotPanel& panel) {
  axis::Extent x;
  axis::Extent y;
  for (const render::PlotLine& line : panel.lines) {
    if (!line.fits) continue;
    for (std::size_t i = 0; i < line.x.size(); ++i) {
      const double at_x = on_axis(line.x[i], panel.x_log);
      const double at_y = on_axis(line.y[i], panel.y_log);
      if (!std::isfinite(at_x) || !std::isfinite(at_y)) continue;
      x.add(at_x);
      y.add(at_y);
    }
  }
  for (const render::PlotBand& band : panel.bands) {
    if (!band.fits) continue;
    y.add(on_axis(band.lower, panel.y_log));
    y.add(on_axis(band.upper, panel.y_log));
  }
  if (panel.field) {
    for (const double edge : {panel.field->x.lower, panel.field->x.upper}) x.add(edge);
    for (const double edge : {panel.field->y.lower, panel.field->y.upper}) y.add(edge);
  }
  Axes axes{{},
            x.range(panel.equal_aspect ? kMarginShare : 0.02),
            y.range(kMarginShare),
            panel.x_log,
            panel.y_log};
  if (panel.x_range) axes.x = on_axis(*panel.x_range, panel.x_log);
  if (panel.y_range) axes.y = on_axis(*panel.y_range, panel.y_log);
  if (panel.y_from_zero && !panel.y_range && axes.y.upper > 0) axes.y.lower = 0;
  return axes;
}

Axes fitted(const render::PlotPanel& panel, const Layout& layout) {
  Axes axes = ranges_of(panel);
  const Margins& m = layout.margins;
  axes.box = {layout.place.x + m.left, layout.place.y + m.top,
              layout.place.width - m.left - m.right, layout.place.height - m.top - m.bottom};
  if (panel.equal_aspect) axis::equalise(axes.x, axes.y, axes.box.width, axes.box.height);
  return axes;
}

axis::Ticks x_ticks(const Axes& axes) {
  const int count = static_cast<int>(axes.box.width / 38);
  return axes.x_log ? axis::log_ticks_for(axes.x, count) : axis::ticks_for(axes.x, count);
}
axis::Ticks y_ticks(const Axes& axes) {
  const int count = static_cast<int>(axes.box.height / 24);
  return axes.y_log ? axis::log_ticks_for(axes.y, count) : axis::ticks_for(axes.y, count);
}

double widest(const axis::Ticks& ticks) {
  double width = 0;
  for (const std::string& label : ticks.labels) {
    width = std::max(width, canvas::text_width(label, kTick));
  }
  return width;
}

std::vector<double> dash_of(render::LineStyle style) {
  if (style == render::LineStyle::dashed) return {4.5, 2.5};
  if (style == render::LineStyle::dotted) return {1.2, 1.8};
  return {};
}

void add_line(Page& page, std::vector<Point> points, const render::Rgba& color, double width,
              render::LineStyle style = render::LineStyle::solid) {
  page.items.push_back(canvas::Polyline{std::move(points), {color, width, dash_of(style)}});
}

void draw_grid(const Axes& axes, const axis::Ticks& xs, const axis::Ticks& ys, Page& page) {
  const Box& box = axes.box;
  const double bottom = box.y + box.height;
  for (std::size_t i = 0; i < xs.at.size(); ++i) {
    const double x = axes.mark_x(xs.at[i]);
    add_line(page, {{x, box.y}, {x, bottom}}, kGrid, 0.5);
    add_line(page, {{x, bottom}, {x, bottom + kTickLength}}, kAxis, 0.6);
    page.items.push_back(
        canvas::Text{{x, bottom + 10}, xs.labels[i], aligned(kTick, Align::middle)});
  }
  for (std::size_t i = 0; i < ys.at.size(); ++i) {
    const double y = axes.mark_y(ys.at[i]);
    add_line(page, {{box.x, y}, {box.x + box.width, y}}, kGrid, 0.5);
    add_line(page, {{box.x - kTickLength, y}, {box.x, y}}, kAxis, 0.6);
    page.items.push_back(
        canvas::Text{{box.x - kAwayFromText, y + 2.5}, ys.labels[i], aligned(kTick, Align::right)});
  }
  if (!ys.factor.empty()) page.items.push_back(canvas::Text{{box.x, box.y - 4}, ys.factor, kTick});
  if (!xs.factor.empty()) {
    page.items.push_back(
        canvas::Text{{box.x + box.width, bottom + 20}, xs.factor, aligned(kTick, Align::right)});
  }
}

void draw_frame(const render::PlotPanel& panel, const Layout& layout, const Axes& axes,
                Page& page) {
  const Box& box = axes.box;
  const double bottom = box.y + box.height;
  add_line(page, {{box.x, box.y}, {box.x, bottom}, {box.x + box.width, bottom}}, kAxis, 0.7);
  if (!panel.title.empty()) {
    page.items.push_back(canvas::Text{{box.x, layout.place.y + 12}, panel.title, kTitle});
  }
  if (!panel.x_label.empty()) {
    page.items.push_back(canvas::Text{{box.x + box.width / 2, bottom + 21}, panel.x_label, kLabel});
  }
  if (!panel.y_label.empty()) {
    TextStyle style = kLabel;
    style.upright = true;
    page.items.push_back(
        canvas::Text{{layout.place.x + 11, box.y + box.height / 2}, panel.y_label, style});
  }
}

/// Points closer together than the eye can see are left out.
void draw_curve(const render::PlotLine& line, const render::Rgba& color, const Axes& axes,
                Page& page) {
  constexpr double kNearest = 0.2;  // [pt]
  std::vector<Point> points;
  const auto end_part = [&] {
    if (line.style == render::LineStyle::points) {
      if (!points.empty()) page.items.push_back(canvas::Dots{points, line.width, color});
    } else if (points.size() > 1) {
      add_line(page, points, color, line.width, line.style);
    }
    points.clear();
  };
  Point last;
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    last = {axes.to_x(line.x[i]), axes.to_y(line.y[i])};
    if (!std::isfinite(last.x) || !std::isfinite(last.y)) {
      end_part();
      continue;
    }
    const bool final_point = i + 1 == line.x.size();
    if (points.empty() || final_point ||
        std::hypot(last.x - points.back().x, last.y - points.back().y) >= kNearest) {
      points.push_back(last);
    }
  }
  end_part();
}

void draw_legend(const std::vector<Entry>& legend, const Axes& axes, double top, Page& page) {
  for (const Entry& entry : legend) {
    const double x = axes.box.x + entry.x;
    const double y = top + kLegendHeight * entry.row + 8;
    const double middle = y - 2.7;
    if (entry.line == nullptr) {
      page.items.push_back(canvas::Fill{{x, y - 6.2, kSample, 7}, entry.color});
    } else if (entry.line->style == render::LineStyle::points) {
      page.items.push_back(
          canvas::Dots{{{x + kSample / 2, middle}}, entry.line->width, entry.color});
    } else {
      add_line(page, {{x, middle}, {x + kSample, middle}}, entry.color, entry.line->width,
               entry.line->style);
    }
    page.items.push_back(canvas::Text{{x + kSample + kAwayFromText, y}, entry.label, kLegend});
  }
}

double title_height(const render::PlotPanel& panel) { return panel.title.empty() ? 4 : 17; }

}  // namespace

Layout measure(const render::PlotPanel& panel, const Box& place) {
  Layout layout{place, {40, 20, 8, 28}};
  if (panel.x_label.empty()) layout.margins.bottom = 17;
  if (panel.field) layout.margins.right += field::kScaleWidth;
  // The ticks depend on the room for them, and the room on the ticks: twice is enough.
  for (int round = 0; round < 2; ++round) {
    const Axes axes = fitted(panel, layout);
    const axis::Ticks ticks = y_ticks(axes);
    const int rows = rows_of(legend_of(panel, axes.box.width));
    layout.margins.left = (panel.y_label.empty() ? 4 : 16) + widest(ticks) + kAwayFromText + 2;
    layout.margins.top =
        title_height(panel) + rows * kLegendHeight + 3 + (ticks.factor.empty() ? 0 : 9);
  }
  return layout;
}

void draw(const render::PlotPanel& panel, const Layout& layout, Page& page) {
  const Axes axes = fitted(panel, layout);
  draw_grid(axes, x_ticks(axes), y_ticks(axes), page);
  page.items.push_back(canvas::Clip{axes.box});
  if (panel.field) {
    const render::PlotRange& y = panel.field->y;
    const double left = axes.to_x(panel.field->x.lower);
    const double top = axes.to_y(y.upper);
    field::draw_cells(*panel.field,
                      {left, top, axes.to_x(panel.field->x.upper) - left, axes.to_y(y.lower) - top},
                      page);
  }
  for (const render::PlotBand& band : panel.bands) {
    constexpr double kFar = 1e5;  // [pt] coordinates of millions are too many for cairo
    const auto edge = [&](double value) { return std::clamp(axes.to_y(value), -kFar, kFar); };
    const double top = edge(band.upper);
    page.items.push_back(
        canvas::Fill{{axes.box.x, top, axes.box.width, edge(band.lower) - top}, kBand});
  }
  const std::vector<render::Rgba> colors = colors_of(panel);
  for (std::size_t i = 0; i < panel.lines.size(); ++i) {
    draw_curve(panel.lines[i], colors[i], axes, page);
  }
  page.items.push_back(canvas::Unclip{});
  draw_frame(panel, layout, axes, page);
  if (panel.field) field::draw_scale(*panel.field, axes.box, page);
  draw_legend(legend_of(panel, axes.box.width), axes, layout.place.y + title_height(panel), page);
}

}  // namespace mjarm::panel

mjarm::render::Rgba mjarm::render::plot_color(int index) {
  return panel::kPalette[static_cast<std::size_t>(index) % panel::kPalette.size()];
}
