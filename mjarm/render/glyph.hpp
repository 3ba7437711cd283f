#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace mjarm::render {

/// One letter as pixels, from the font that has it.
struct Glyph {
  int width = 0;    ///< [pixels]
  int height = 0;   ///< [pixels]
  int left = 0;     ///< [pixels] from the pen to the first column
  int bottom = 0;   ///< [pixels] from the base line up to the lowest row; negative below it
  int advance = 0;  ///< [pixels] the pen moves on by
  std::vector<std::uint8_t> ink =
      {};  ///< shape (height * width,), from the lowest row up; 0 to 255
};

/// A text cut into its letters, each the UTF-8 of one character; bytes that are no UTF-8 become
/// U+FFFD.
[[nodiscard]] std::vector<std::string> letters_of(std::string_view text);

/// Draws a letter (UTF-8 of one character), Chinese ones with `chinese_font`.
/// @param size  [pixels] of the font, > 0.
[[nodiscard]] Glyph draw_glyph(const std::string& letter, double size);

}  // namespace mjarm::render
