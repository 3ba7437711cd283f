#include <algorithm>
#include <array>
#include <cmath>

#include "mjarm/render/axis_internal.hpp"
#include "mjarm/render/field_internal.hpp"

namespace mjarm::field {
namespace {

using canvas::Box;
using canvas::Page;

/// From dark to bright through blue and green, so that it reads in grey and by colour-blind eyes.
constexpr std::array<render::Rgba, 6> kColors = {{{0.27F, 0.00F, 0.33F, 1},
                                                  {0.25F, 0.27F, 0.53F, 1},
                                                  {0.16F, 0.47F, 0.56F, 1},
                                                  {0.13F, 0.66F, 0.52F, 1},
                                                  {0.48F, 0.82F, 0.32F, 1},
                                                  {0.99F, 0.91F, 0.14F, 1}}};
constexpr int kLevels = 64;          // shades of a continuous scale
constexpr double kOverlap = 0.25;    // [pt] neighbours overlap, so that no seam shows
constexpr double kBarWidth = 9;      // [pt]
constexpr double kBarDistance = 8;   // [pt] from the axes
constexpr double kAwayFromText = 3;  // [pt]
constexpr canvas::TextStyle kTick{.size = 7, .color = {0.3F, 0.3F, 0.3F, 1}};

/// How values become colours.
struct Scale {
  render::PlotRange range;  ///< of whole numbers: half a number wider at both ends
  int levels = kLevels;

  /// Number of the colour; -1 for a bare cell.
  [[nodiscard]] int level(double value) const {
    if (std::isnan(value)) return -1;
    const double share = (value - range.lower) / (range.upper - range.lower);
    return static_cast<int>(std::clamp(std::floor(share * levels), 0.0, levels - 1.0));
  }
  [[nodiscard]] render::Rgba color(int level) const {
    const double at = levels == 1 ? 0 : (kColors.size() - 1.0) * level / (levels - 1.0);
    const auto below = std::min(static_cast<std::size_t>(at), kColors.size() - 2);
    const auto t = static_cast<float>(at - static_cast<double>(below));
    const render::Rgba& a = kColors[below];
    const render::Rgba& b = kColors[below + 1];
    return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b), 1};
  }
};

Scale scale_of(const render::PlotField& field) {
  axis::Extent extent;
  for (const double value : field.values) extent.add(value);
  const render::PlotRange range = field.colors.value_or(extent.range(0));
  if (!field.whole_numbers) return {range};
  const double lower = std::round(range.lower);
  const double upper = std::max(std::round(range.upper), lower);
  const int levels = static_cast<int>(std::min(upper - lower + 1, double{kLevels}));
  return {{lower - 0.5, upper + 0.5}, levels};
}

axis::Ticks ticks_of(const render::PlotField& field, const Scale& scale, double height) {
  axis::Ticks ticks = axis::ticks_for(scale.range, static_cast<int>(height / 16));
  if (!field.whole_numbers) return ticks;
  axis::Ticks whole;
  for (std::size_t i = 0; i < ticks.at.size(); ++i) {
    if (ticks.at[i] != std::round(ticks.at[i])) continue;
    whole.at.push_back(ticks.at[i]);
    whole.labels.push_back(std::to_string(std::lround(ticks.at[i])));
  }
  return whole;
}

}  // namespace

void draw_cells(const render::PlotField& field, const Box& box, Page& page) {
  const Scale scale = scale_of(field);
  const auto columns = static_cast<std::size_t>(field.columns);
  const std::size_t rows = field.values.size() / columns;
  const double width = box.width / static_cast<double>(columns);
  const double height = box.height / static_cast<double>(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const double top = box.y + box.height - static_cast<double>(row + 1) * height;
    for (std::size_t from = 0, to = 0; from < columns; from = to) {  // cells of one colour are one
      const int level = scale.level(field.values[row * columns + from]);
      while (to < columns && scale.level(field.values[row * columns + to]) == level) ++to;
      if (level < 0) continue;
      page.items.push_back(
          canvas::Fill{{box.x + static_cast<double>(from) * width, top,
                        static_cast<double>(to - from) * width + kOverlap, height + kOverlap},
                       scale.color(level)});
    }
  }
}

void draw_scale(const render::PlotField& field, const Box& box, Page& page) {
  const Scale scale = scale_of(field);
  const double left = box.x + box.width + kBarDistance;
  const double step = box.height / scale.levels;
  for (int level = 0; level < scale.levels; ++level) {
    page.items.push_back(
        canvas::Fill{{left, box.y + box.height - (level + 1) * step, kBarWidth, step + kOverlap},
                     scale.color(level)});
  }
  const axis::Ticks ticks = ticks_of(field, scale, box.height);
  const double x = left + kBarWidth + kAwayFromText;
  for (std::size_t i = 0; i < ticks.at.size(); ++i) {
    const double share =
        (ticks.at[i] - scale.range.lower) / (scale.range.upper - scale.range.lower);
    page.items.push_back(
        canvas::Text{{x, box.y + box.height * (1 - share) + 2.5}, ticks.labels[i], kTick});
  }
  if (!ticks.factor.empty())
    page.items.push_back(canvas::Text{{left, box.y - 4}, ticks.factor, kTick});
}

}  // namespace mjarm::field
