#include "mjarm/render/cairo_internal.hpp"
#include "mjarm/render/fonts.hpp"

namespace mjarm::canvas {

void set_font_options(cairo_t* cr) {
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(cr, options);
  cairo_font_options_destroy(options);
}

void select_font(cairo_t* cr, bool cjk, const TextStyle& style) {
  const std::string& chinese = render::chinese_font();
  cairo_select_font_face(cr, cjk && !chinese.empty() ? chinese.c_str() : "DejaVu Sans",
                         CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cr, style.size);
}

}  // namespace mjarm::canvas
