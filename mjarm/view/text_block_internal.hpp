#pragma once

#include <mujoco/mujoco.h>

#include <string>
#include <vector>

#include "mjarm/view/glyph_font_internal.hpp"

namespace mjarm::view {

/// What texts in a window are drawn with.
struct TextTools {
  const mjrContext& context;
  GlyphFont& font;  ///< for what MuJoCo's own has no letters for
  PixelBox window;  ///< all of it

  /// Height of a line and what is between two [pixels].
  [[nodiscard]] int line() const { return context.charHeight + 4; }
  /// [pixels]
  [[nodiscard]] int width(const std::string& text) const;
  /// Draws a text with its lower left corner there [pixels of the window]; grey of that shade.
  void draw(const std::string& text, int left, int bottom, float shade) const;
};

/// A row of a text block: a name and its value, or only one of them.
struct TextRow {
  std::string name;
  std::string value = {};
};

/// Draws rows on a dark ground in a corner of `view`: names grey, values white.
/// @param top  at the upper left, else the lower left.
void draw_text_block(const std::vector<TextRow>& rows, const mjrRect& view, bool top,
                     const TextTools& tools);

}  // namespace mjarm::view
