#include <array>
#include <cmath>
#include <numbers>

#include "mjarm/core/messages/render.hpp"
#include "mjarm/render/cairo_internal.hpp"

namespace mjarm::canvas {
namespace {

double width_of(cairo_t* cr, std::string_view text, const TextStyle& style) {
  double width = 0;
  for (const Run& run : runs_of(text)) {
    select_font(cr, run.cjk, style);
    cairo_text_extents_t extents;
    cairo_text_extents(cr, run.text.c_str(), &extents);
    width += extents.x_advance;
  }
  return width;
}

struct Painter {
  cairo_t* cr;

  void set_color(const render::Rgba& color) const {
    cairo_set_source_rgba(cr, color.r, color.g, color.b, color.a);
  }
  void add_box(const Box& box) const { cairo_rectangle(cr, box.x, box.y, box.width, box.height); }
  void operator()(const Polyline& line) const {
    if (line.points.empty()) return;
    set_color(line.stroke.color);
    cairo_set_line_width(cr, line.stroke.width);
    cairo_set_dash(cr, line.stroke.dash.data(), static_cast<int>(line.stroke.dash.size()), 0);
    cairo_new_path(cr);  // a text leaves a point behind
    for (const Point& p : line.points) cairo_line_to(cr, p.x, p.y);
    cairo_stroke(cr);
  }
  void operator()(const Dots& dots) const {
    set_color(dots.color);
    for (const Point& p : dots.centres) {
      cairo_new_path(cr);
      cairo_arc(cr, p.x, p.y, dots.radius, 0, 2 * std::numbers::pi);
      cairo_fill(cr);
    }
  }
  void operator()(const Fill& fill) const {
    set_color(fill.color);
    cairo_new_path(cr);
    add_box(fill.box);
    cairo_fill(cr);
  }
  void operator()(const Text& text) const {
    cairo_save(cr);
    set_color(text.style.color);
    cairo_translate(cr, text.at.x, text.at.y);
    if (text.style.upright) cairo_rotate(cr, -std::numbers::pi / 2);
    const double width = width_of(cr, text.text, text.style);
    constexpr std::array<double, 3> kShare = {0, -0.5, -1};
    cairo_move_to(cr, kShare[static_cast<std::size_t>(text.style.align)] * width, 0);
    for (const Run& run : runs_of(text.text)) {
      select_font(cr, run.cjk, text.style);
      cairo_show_text(cr, run.text.c_str());
    }
    cairo_restore(cr);
  }
  void operator()(const Clip& clip) const {
    cairo_save(cr);
    add_box(clip.box);
    cairo_clip(cr);
  }
  void operator()(const Unclip&) const { cairo_restore(cr); }
};

/// Cairo's pixels are 0xAARRGGBB in rows that may be padded.
render::Image image_of(cairo_surface_t* surface, int width, int height) {
  cairo_surface_flush(surface);
  const unsigned char* data = cairo_image_surface_get_data(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  render::Image image{width, height, {}};
  image.rgb.reserve(3 * static_cast<std::size_t>(width) * height);
  for (int y = 0; y < height; ++y) {
    const auto* row = reinterpret_cast<const std::uint32_t*>(data + std::size_t{1} * y * stride);
    for (int x = 0; x < width; ++x) {
      for (const int shift : {16, 8, 0}) {
        image.rgb.push_back(static_cast<std::uint8_t>(row[x] >> shift));
      }
    }
  }
  return image;
}

}  // namespace

double text_width(std::string_view text, const TextStyle& style) {
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, 1, 1));
  const Context cr(cairo_create(surface.get()));
  set_font_options(cr.get());
  return width_of(cr.get(), text, style);
}

Result<render::Image> to_image(const Page& page, double pixels_per_point) {
  const int width = static_cast<int>(std::lround(page.width * pixels_per_point));
  const int height = static_cast<int>(std::lround(page.height * pixels_per_point));
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height));
  const Context context(cairo_create(surface.get()));
  cairo_t* cr = context.get();
  cairo_set_source_rgb(cr, 1, 1, 1);
  cairo_paint(cr);
  cairo_scale(cr, pixels_per_point, pixels_per_point);
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  set_font_options(cr);
  for (const Item& item : page.items) std::visit(Painter{cr}, item);
  if (const cairo_status_t status = cairo_status(cr); status != CAIRO_STATUS_SUCCESS) {
    return fail(Errc::system, text(msg::render_cairo_failed, cairo_status_to_string(status)));
  }
  return image_of(surface.get(), width, height);
}

}  // namespace mjarm::canvas
