#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace mjarm::render {

/// A picture: 8-bit red, green, blue (sRGB) for each pixel, rows from top to bottom.
struct Image {
  int width = 0;                       ///< [px]
  int height = 0;                      ///< [px]
  std::vector<std::uint8_t> rgb = {};  ///< shape (height, width, 3), row by row

  /// The pixel in column `x` (from the left) and row `y` (from the top), both inside the picture.
  [[nodiscard]] std::array<std::uint8_t, 3> pixel(int x, int y) const {
    const std::size_t at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                static_cast<std::size_t>(x));
    return {rgb[at], rgb[at + 1], rgb[at + 2]};
  }
};

}  // namespace mjarm::render
