#include "mjarm/render/glyph.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/render/cairo_internal.hpp"

namespace mjarm::render {

std::vector<std::string> letters_of(std::string_view text) {
  std::vector<std::string> letters;
  for (const canvas::Run& run : canvas::runs_of(text)) {
    for (std::size_t from = 0; from < run.text.size();) {
      std::size_t to = from + 1;
      while (to < run.text.size() && (static_cast<unsigned char>(run.text[to]) & 0xC0U) == 0x80U) {
        ++to;
      }
      letters.push_back(run.text.substr(from, to - from));
      from = to;
    }
  }
  return letters;
}

Glyph draw_glyph(const std::string& letter, double size) {
  const std::vector<canvas::Run> runs = canvas::runs_of(letter);
  const bool cjk = !runs.empty() && runs.front().cjk;
  const int side = static_cast<int>(std::ceil(2 * size)) + 2;  // no letter is larger
  const int base = side / 4;                                   // rows below the base line
  const canvas::Surface surface(cairo_image_surface_create(CAIRO_FORMAT_A8, side, side));
  const canvas::Context cr(cairo_create(surface.get()));
  canvas::set_font_options(cr.get());
  canvas::select_font(cr.get(), cjk, {.size = size});
  cairo_text_extents_t extents;
  cairo_text_extents(cr.get(), letter.c_str(), &extents);
  Glyph glyph;
  glyph.advance = static_cast<int>(std::lround(extents.x_advance));
  glyph.left = static_cast<int>(std::floor(extents.x_bearing)) - 1;
  cairo_move_to(cr.get(), -glyph.left, side - base);
  cairo_show_text(cr.get(), letter.c_str());
  cairo_surface_flush(surface.get());
  if (cairo_status(cr.get()) != CAIRO_STATUS_SUCCESS) return glyph;
  const unsigned char* data = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  glyph.width = std::min(side, static_cast<int>(std::ceil(extents.width)) + 2);
  glyph.height = side;
  glyph.bottom = -base;
  for (int y = side - 1; y >= 0; --y) {
    const unsigned char* row = data + static_cast<std::ptrdiff_t>(y) * stride;
    glyph.ink.insert(glyph.ink.end(), row, row + glyph.width);
  }
  return glyph;
}

}  // namespace mjarm::render
