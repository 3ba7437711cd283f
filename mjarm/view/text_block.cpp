#include <algorithm>

#include "mjarm/view/text_block_internal.hpp"

namespace mjarm::view {

int TextTools::width(const std::string& text) const {
  if (!is_ascii(text)) return font.width(text);
  int width = 0;
  for (const char c : text) width += context.charWidth[static_cast<unsigned char>(c) % 127];
  return width;
}

void TextTools::draw(const std::string& text, int left, int bottom, float shade) const {
  if (is_ascii(text)) {
    mjr_rectangle({0, 0, window.width, window.height}, 0, 0, 0, 0);  // sets the place
    mjr_text(mjFONT_NORMAL, text.c_str(), &context,
             static_cast<float>(left) / static_cast<float>(window.width),
             static_cast<float>(bottom) / static_cast<float>(window.height), shade, shade, shade);
    return;
  }
  const float rgb[3] = {shade, shade, shade};
  const PixelBox box{left, bottom, window.width - left, line() + 4};
  font.draw(text, window, box, rgb, box.width);
}

void draw_text_block(const std::vector<TextRow>& rows, const mjrRect& view, bool top,
                     const TextTools& tools) {
  constexpr int kEdge = 5;  // [pixels] round the block and in it
  constexpr float kGrey = 0.7F;
  if (rows.empty() || view.width <= 0) return;
  int names = 0;
  int values = 0;
  for (const TextRow& row : rows) {
    names = std::max(names, tools.width(row.name));
    values = std::max(values, tools.width(row.value));
  }
  const int gap = names > 0 && values > 0 ? 2 * kEdge : 0;
  const int height = static_cast<int>(rows.size()) * tools.line() + kEdge;
  mjrRect box = {view.left + kEdge, view.bottom + kEdge, names + gap + values + 2 * kEdge, height};
  if (top) box.bottom = view.bottom + view.height - kEdge - height;
  box.width = std::min(box.width, view.width - 2 * kEdge);
  mjr_rectangle(box, 0, 0, 0, 0.5F);
  int y = box.bottom + height - tools.line();
  for (const TextRow& row : rows) {
    tools.draw(row.name, box.left + kEdge, y, row.value.empty() ? 1 : kGrey);
    if (!row.value.empty()) tools.draw(row.value, box.left + kEdge + names + gap, y, 1);
    y -= tools.line();
  }
}

}  // namespace mjarm::view
