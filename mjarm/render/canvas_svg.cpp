#include <algorithm>
#include <charconv>
#include <cmath>

#include "mjarm/core/hex.hpp"
#include "mjarm/render/canvas_internal.hpp"

namespace mjarm::canvas {
namespace {

/// Two decimals, without what is not needed: "12.5", "-0.04", "3".
std::string coordinate(double value) {
  char digits[64];
  const double rounded = std::round(value * 100) / 100;
  const auto [end, error] =
      std::to_chars(digits, digits + sizeof(digits), rounded + 0.0, std::chars_format::fixed, 2);
  std::string text = error == std::errc() ? std::string(digits, end) : "0";
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string pair_of(const Point& p) { return coordinate(p.x) + "," + coordinate(p.y); }

std::string hex(const render::Rgba& color) {
  std::string text = "#";
  for (const float part : {color.r, color.g, color.b}) {
    append_hex(text, static_cast<unsigned char>(std::lround(std::clamp(part, 0.0F, 1.0F) * 255)));
  }
  return text;
}

std::string opacity(const char* what, const render::Rgba& color) {
  if (color.a >= 1) return {};
  return std::string(" ") + what + "-opacity=\"" + coordinate(color.a) + "\"";
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const Run& run : runs_of(text)) {  // also mends what is no UTF-8
    for (const char c : run.text) {
      switch (c) {
        case '&':
          out += "&amp;";
          break;
        case '<':
          out += "&lt;";
          break;
        case '>':
          out += "&gt;";
          break;
        default:
          if (static_cast<unsigned char>(c) >= 32) out += c;
      }
    }
  }
  return out;
}

struct Writer {
  std::string out;
  int clips = 0;

  void operator()(const Polyline& line) {
    out += "<polyline fill=\"none\" stroke=\"" + hex(line.stroke.color) + "\"" +
           opacity("stroke", line.stroke.color) + " stroke-width=\"" +
           coordinate(line.stroke.width) + "\"";
    if (!line.stroke.dash.empty()) {
      out += " stroke-dasharray=\"";
      for (const double length : line.stroke.dash) out += coordinate(length) + " ";
      out.back() = '"';
    }
    out += " points=\"";
    for (const Point& p : line.points) out += pair_of(p) + " ";
    if (out.back() == ' ') out.pop_back();
    out += "\"/>\n";
  }
  void operator()(const Dots& dots) {
    out += "<g fill=\"" + hex(dots.color) + "\"" + opacity("fill", dots.color) + ">\n";
    for (const Point& p : dots.centres) {
      out += "<circle cx=\"" + coordinate(p.x) + "\" cy=\"" + coordinate(p.y) + "\" r=\"" +
             coordinate(dots.radius) + "\"/>\n";
    }
    out += "</g>\n";
  }
  void operator()(const Fill& fill) {
    out += "<rect " + place(fill.box) + " fill=\"" + hex(fill.color) + "\"" +
           opacity("fill", fill.color) + "/>\n";
  }
  void operator()(const Text& text) {
    static constexpr const char* kAnchors[] = {"start", "middle", "end"};
    const std::string at =
        "x=\"" + coordinate(text.at.x) + "\" y=\"" + coordinate(text.at.y) + "\"";
    out += "<text " + at + " font-size=\"" + coordinate(text.style.size) + "\" fill=\"" +
           hex(text.style.color) + "\"";
    if (text.style.bold) out += " font-weight=\"bold\"";
    if (text.style.align != Align::left) {
      out += std::string(" text-anchor=\"") + kAnchors[static_cast<int>(text.style.align)] + "\"";
    }
    if (text.style.upright) {
      out +=
          " transform=\"rotate(-90 " + coordinate(text.at.x) + " " + coordinate(text.at.y) + ")\"";
    }
    out += ">" + escaped(text.text) + "</text>\n";
  }
  void operator()(const Clip& clip) {
    const std::string id = "clip" + std::to_string(++clips);
    out += "<defs><clipPath id=\"" + id + "\"><rect " + place(clip.box) + "/></clipPath></defs>\n";
    out += "<g clip-path=\"url(#" + id + ")\">\n";
  }
  void operator()(const Unclip&) { out += "</g>\n"; }

  static std::string place(const Box& box) {
    return "x=\"" + coordinate(box.x) + "\" y=\"" + coordinate(box.y) + "\" width=\"" +
           coordinate(box.width) + "\" height=\"" + coordinate(box.height) + "\"";
  }
};

}  // namespace

std::string to_svg(const Page& page) {
  const std::string width = coordinate(page.width);
  const std::string height = coordinate(page.height);
  Writer writer;
  writer.out =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" +
      width + "pt\" height=\"" + height + "pt\" viewBox=\"0 0 " + width + " " + height +
      "\" font-family=\"'DejaVu Sans', Verdana, 'Noto Sans CJK SC', 'Microsoft YaHei', "
      "sans-serif\" stroke-linejoin=\"round\" stroke-linecap=\"butt\">\n";
  for (const Item& item : page.items) std::visit(writer, item);
  return writer.out + "</svg>\n";
}

}  // namespace mjarm::canvas
