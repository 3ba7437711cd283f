#include "mjarm/render/picture_legend.hpp"

#include <algorithm>
#include <array>
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

/// Where in the picture the first pixel of the legend is.
struct LegendPlace {
  int x = 0;
  int y = 0;
};
LegendPlace place_of(const Corner& corner, const Image& image, const Image& legend) {
  return {corner.right ? image.width - legend.width : 0,
          corner.top ? 0 : image.height - legend.height};
}

/// Pixels with a colour of their own that the legend would hide: floors and walls are nearly grey.
int hidden_colors(const Corner& corner, const Image& image, const Image& legend) {
  constexpr int kGrey = 45;  // largest difference between the parts of a colour
  const LegendPlace at = place_of(corner, image, legend);
  int count = 0;
  for (int y = 0; y < legend.height; ++y) {
    for (int x = 0; x < legend.width; ++x) {
      const std::array<std::uint8_t, 3> rgb = image.pixel(at.x + x, at.y + y);
      const auto [low, high] = std::ranges::minmax(rgb);
      count += high - low > kGrey ? 1 : 0;
    }
  }
  return count;
}

void paint(const Image& legend, const LegendPlace& place, Image& image) {
  for (int y = 0; y < legend.height; ++y) {
    for (int x = 0; x < legend.width; ++x) {
      const std::array<std::uint8_t, 3> ink = legend.pixel(x, y);
      const bool ground = ink[0] == 255 && ink[1] == 255 && ink[2] == 255;
      const auto at =
          3 * (static_cast<std::size_t>(place.y + y) * static_cast<std::size_t>(image.width) +
               static_cast<std::size_t>(place.x + x));
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

}  // namespace

Corner add_legend(Image& image, std::span<const LegendEntry> entries,
                  std::optional<Corner> corner) {
  if (entries.empty() || image.height < kLeastHigh) return {};
  const Result<Image> legend = canvas::to_image(page_of(entries), image.height / kPointsHigh);
  if (!legend || legend->width > image.width || legend->height > image.height) return {};
  static constexpr Corner kCorners[] = {{}, {.right = true}, {.top = true}, {true, true}};
  const Corner chosen = corner.value_or(*std::ranges::min_element(
      kCorners, {}, [&](const Corner& one) { return hidden_colors(one, image, *legend); }));
  paint(*legend, place_of(chosen, image, *legend), image);
  return chosen;
}

}  // namespace mjarm::render
