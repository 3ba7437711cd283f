#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/render/image.hpp"
#include "mjarm/render/overlay.hpp"

/// A page as a list of simple things, laid out once and then written as SVG or painted as pixels.
/// All lengths are points [pt], y runs down.
namespace mjarm::canvas {

struct Point {
  double x = 0;
  double y = 0;
};

struct Box {
  double x = 0;
  double y = 0;
  double width = 0;
  double height = 0;
};

/// How a line is drawn.
struct Stroke {
  render::Rgba color;
  double width = 1;
  std::vector<double> dash = {};  ///< lengths on, off, ...; empty = unbroken
};

enum class Align { left, middle, right };

struct TextStyle {
  double size = 8;
  bool bold = false;
  Align align = Align::left;
  bool upright = false;  ///< turned to read from bottom to top
  render::Rgba color = {0.2F, 0.2F, 0.2F, 1};
};

struct Polyline {
  std::vector<Point> points;
  Stroke stroke;
};
struct Dots {
  std::vector<Point> centres;
  double radius = 1;
  render::Rgba color;
};
struct Fill {
  Box box;
  render::Rgba color;
};
struct Text {
  Point at;  ///< on the base line
  std::string text;
  TextStyle style;
};
/// What follows is seen only inside the box, until the next `Unclip`.
struct Clip {
  Box box;
};
struct Unclip {};
using Item = std::variant<Polyline, Dots, Fill, Text, Clip, Unclip>;

struct Page {
  double width = 0;
  double height = 0;
  std::vector<Item> items;
};

/// A piece of text that one font can show.
struct Run {
  std::string text;
  bool cjk = false;  ///< Chinese characters and their punctuation
};
/// Cuts a UTF-8 text into runs; bytes that are no UTF-8 become U+FFFD.
[[nodiscard]] std::vector<Run> runs_of(std::string_view text);

/// Width of a text [pt] with the fonts of this machine.
[[nodiscard]] double text_width(std::string_view text, const TextStyle& style);

[[nodiscard]] std::string to_svg(const Page& page);
[[nodiscard]] Result<render::Image> to_image(const Page& page, double pixels_per_point);

}  // namespace mjarm::canvas
