#pragma once

#include <cairo.h>

#include <memory>

#include "mjarm/render/canvas_internal.hpp"

namespace mjarm::canvas {

struct DeleteContext {
  void operator()(cairo_t* cr) const { cairo_destroy(cr); }
};
struct DeleteSurface {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
using Context = std::unique_ptr<cairo_t, DeleteContext>;
using Surface = std::unique_ptr<cairo_surface_t, DeleteSurface>;

/// Letters are placed as in print, the same at every size, and smoothed in grey.
void set_font_options(cairo_t* cr);
/// The font for a run, Chinese ones that of `render::chinese_font`.
void select_font(cairo_t* cr, bool cjk, const TextStyle& style);

}  // namespace mjarm::canvas
