#include "mjarm/render/plot.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/render.hpp"
#include "mjarm/render/panel_internal.hpp"
#include "mjarm/render/png.hpp"

namespace mjarm::render {
namespace {

using canvas::Box;
using canvas::Page;

constexpr double kSmallestPanel = 120;  // [pt]
constexpr double kEdge = 8;             // [pt] round the page
constexpr double kTitleHeight = 22;     // [pt]
constexpr double kNoteHeight = 16;      // [pt]

bool is_range(const PlotRange& range) {
  return std::isfinite(range.lower) && std::isfinite(range.upper) && range.lower < range.upper;
}

Result<void> check_field(const PlotField& field, std::size_t number) {
  for (const PlotRange& range : {field.x, field.y, field.colors.value_or(PlotRange{})}) {
    if (is_range(range)) continue;
    return fail(Errc::bad_input, text(msg::render_plot_range, number, range.lower, range.upper));
  }
  const std::size_t columns = static_cast<std::size_t>(std::max(field.columns, 0));
  if (columns > 0 && !field.values.empty() && field.values.size() % columns == 0) return {};
  return fail(Errc::bad_input,
              text(msg::render_plot_field, number, field.values.size(), field.columns));
}

Result<void> check_panel(const PlotPanel& panel, std::size_t number) {
  for (std::size_t i = 0; i < panel.lines.size(); ++i) {
    const PlotLine& line = panel.lines[i];
    if (line.x.size() == line.y.size()) continue;
    return fail(Errc::bad_input,
                text(msg::render_plot_lengths, number, i + 1, line.x.size(), line.y.size()));
  }
  for (const auto& [range, log] :
       {std::pair(panel.x_range, panel.x_log), {panel.y_range, panel.y_log}}) {
    if (!range || (is_range(*range) && (!log || range->lower > 0))) continue;
    return fail(Errc::bad_input, text(msg::render_plot_range, number, range->lower, range->upper));
  }
  for (const PlotBand& band : panel.bands) {
    if (std::isfinite(band.lower) && std::isfinite(band.upper)) continue;
    return fail(Errc::bad_input, text(msg::render_plot_range, number, band.lower, band.upper));
  }
  if (panel.field) return check_field(*panel.field, number);
  return {};
}

Result<void> check(const Plot& plot) {
  const auto fits = [](double size) { return size >= kSmallestPanel && std::isfinite(size); };
  const bool large = fits(plot.panel_width) && fits(plot.panel_height);
  if (plot.panels.empty() || plot.columns < 1 || !large) {
    return fail(Errc::bad_input, text(msg::render_plot_empty, kSmallestPanel));
  }
  for (std::size_t i = 0; i < plot.panels.size(); ++i) {
    if (Result<void> checked = check_panel(plot.panels[i], i + 1); !checked) return checked;
  }
  return {};
}

/// Axes of one column begin at one x, those of one row at one y.
void align(std::vector<panel::Layout>& layouts, std::size_t columns) {
  for (std::size_t i = 0; i < layouts.size(); ++i) {
    panel::Margins& margins = layouts[i].margins;
    for (std::size_t k = i % columns; k < layouts.size(); k += columns) {
      margins.left = std::max(margins.left, layouts[k].margins.left);
    }
    const std::size_t row = i - i % columns;
    for (std::size_t k = row; k < std::min(row + columns, layouts.size()); ++k) {
      margins.top = std::max(margins.top, layouts[k].margins.top);
      margins.bottom = std::max(margins.bottom, layouts[k].margins.bottom);
    }
  }
}

Page lay_out(const Plot& plot) {
  const std::size_t columns = std::min(static_cast<std::size_t>(plot.columns), plot.panels.size());
  const std::size_t rows = (plot.panels.size() + columns - 1) / columns;
  const double top = kEdge + (plot.title.empty() ? 0 : kTitleHeight);
  Page page;
  page.width = 2 * kEdge + static_cast<double>(columns) * plot.panel_width;
  page.height = top + static_cast<double>(rows) * plot.panel_height + kEdge +
                (plot.note.empty() ? 0 : kNoteHeight);
  page.items.push_back(canvas::Fill{{0, 0, page.width, page.height}, {1, 1, 1, 1}});
  if (!plot.title.empty()) {
    const canvas::TextStyle style{.size = 12, .bold = true, .align = canvas::Align::middle};
    page.items.push_back(canvas::Text{{page.width / 2, kEdge + 13}, plot.title, style});
  }
  std::vector<panel::Layout> layouts;
  for (std::size_t i = 0; i < plot.panels.size(); ++i) {
    const Box place = {kEdge + static_cast<double>(i % columns) * plot.panel_width,
                       top + static_cast<double>(i / columns) * plot.panel_height, plot.panel_width,
                       plot.panel_height};
    layouts.push_back(panel::measure(plot.panels[i], place));
  }
  align(layouts, columns);
  for (std::size_t i = 0; i < layouts.size(); ++i) {
    panel::draw(plot.panels[i], layouts[i], page);
  }
  if (!plot.note.empty()) {
    const canvas::TextStyle style{.size = 8, .color = {0.35F, 0.35F, 0.35F, 1}};
    page.items.push_back(canvas::Text{{kEdge + 4, page.height - kEdge}, plot.note, style});
  }
  return page;
}

}  // namespace

PlotLine planned_line(std::vector<double> x, std::vector<double> y) {
  return {.x = std::move(x),
          .y = std::move(y),
          .label = text(msg::render_planned),
          .style = LineStyle::dashed,
          .color = PlotLine::kInk,
          .width = 0.9};
}

PlotLine executed_line(std::vector<double> x, std::vector<double> y) {
  return {.x = std::move(x),
          .y = std::move(y),
          .label = text(msg::render_executed),
          .color = 1,
          .width = 2.2};
}

std::vector<PlotLine> limit_lines(std::span<const double> lower, std::span<const double> upper,
                                  double from, double to, const std::string& label) {
  std::vector<PlotLine> out;
  for (const std::span<const double> side : {lower, upper}) {
    for (std::size_t j = 0; j < side.size(); ++j) {
      const double limit = side[j];
      const auto is_drawn = [limit](const PlotLine& line) { return line.y.front() == limit; };
      if (!std::isfinite(limit) || std::ranges::any_of(out, is_drawn)) continue;
      const bool shared = std::ranges::count(side, limit) > 1;
      out.push_back({.x = {from, to},
                     .y = {limit, limit},
                     .label = out.empty() ? label : std::string(),
                     .style = LineStyle::dotted,
                     .color = shared ? PlotLine::kInk : static_cast<int>(j),
                     .width = 0.9});
    }
  }
  return out;
}

Result<std::string> plot_svg(const Plot& plot) {
  if (Result<void> checked = check(plot); !checked) return fail(std::move(checked.error()));
  return canvas::to_svg(lay_out(plot));
}

Result<Image> plot_image(const Plot& plot, double pixels_per_point) {
  if (Result<void> checked = check(plot); !checked) return fail(std::move(checked.error()));
  return canvas::to_image(lay_out(plot), pixels_per_point);
}

Result<void> save_plot(const Plot& plot, const std::filesystem::path& stem) {
  const Result<std::string> svg = plot_svg(plot);
  if (!svg) return fail(svg.error());
  const Result<Image> image = plot_image(plot);
  if (!image) return fail(image.error());
  if (Result<void> written = write_file(stem.string() + ".svg", *svg); !written) return written;
  return write_png(*image, stem.string() + ".png");
}

}  // namespace mjarm::render
