#include "mjarm/render/picture_legend.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/render/canvas_internal.hpp"

namespace mjarm::render {
namespace {

constexpr double kLegendLine = 15;     // [pt] from one line to the next
constexpr double kSwatch = 12;         // [pt] width of one colour
constexpr double kLegendEdge = 7;      // [pt] round all
constexpr int kLeastHigh = 120;        // [px] of a picture with a legend that can be read
constexpr double kPointsHigh = 520;    // of a picture
constexpr double kGroundShare = 0.82;  // of white over the picture
constexpr canvas::TextStyle kLegendText{.size = 10, .color = {0.1F, 0.1F, 0.12F, 1}};

canvas::Page page_of(std::span<const LegendEntry> entries) {
  std::size_t colors = 1;
  double text = 0;
  for (const LegendEntry& entry : entries) {
    colors = std::max(colors, entry.colors.size());
    text = std::max(text, canvas::text_width(entry.text, kLegendText));
  }
  const double wide = kSwatch * static_cast<double>(colors);
  canvas::Page page{3 * kLegendEdge + wide + text,
                    2 * kLegendEdge + kLegendLine * static_cast<double>(entries.size()),
                    {}};
  double y = kLegendEdge;
  for (const LegendEntry& entry : entries) {
    const double width = wide / static_cast<double>(std::max<std::size_t>(entry.colors.size(), 1));
    for (std::size_t i = 0; i < entry.colors.size(); ++i) {
      Rgba color = entry.colors[i];
      color.a = 1;
      page.items.emplace_back(canvas::Fill{
          {kLegendEdge + width * static_cast<double>(i), y + 3, width, kLegendLine - 6}, color});
    }
    page.items.emplace_back(
        canvas::Text{{2 * kLegendEdge + wide, y + kLegendLine - 4}, entry.text, kLegendText});
    y += kLegendLine;
  }
  return page;
}

}  // namespace

void add_legend(Image& image, std::span<const LegendEntry> entries) {
  if (entries.empty() || image.height < kLeastHigh) return;
  const Result<Image> legend = canvas::to_image(page_of(entries), image.height / kPointsHigh);
  if (!legend || legend->width > image.width || legend->height > image.height) return;
  for (int y = 0; y < legend->height; ++y) {
    for (int x = 0; x < legend->width; ++x) {
      const std::array<std::uint8_t, 3> ink = legend->pixel(x, y);
      const bool ground = ink[0] == 255 && ink[1] == 255 && ink[2] == 255;
      const auto at = 3 * (static_cast<std::size_t>(image.height - legend->height + y) *
                               static_cast<std::size_t>(image.width) +
                           static_cast<std::size_t>(x));
      for (std::size_t c = 0; c < 3; ++c) {
        const double below = image.rgb[at + c];
        const double mixed = kGroundShare * 255 + (1 - kGroundShare) * below;
        // Ink darkens the pale ground as it darkens white.
        image.rgb[at + c] = static_cast<std::uint8_t>(
            std::lround(ground ? mixed : std::min<double>(ink[c], mixed)));
      }
    }
  }
}

}  // namespace mjarm::render
