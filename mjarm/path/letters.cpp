#include "mjarm/path/letters.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "mjarm/core/messages/path.hpp"

namespace mjarm {
namespace {

constexpr double kHeight = 9;  // of the grid all letters are drawn on
constexpr double kGap = 2;     // between two letters
constexpr double kSpace = 4;   // width of a space

/// Strokes of one letter, parted by spaces; a stroke is a row of points, two digits each: x and y.
struct Glyph {
  char letter;
  const char* strokes;
};
constexpr Glyph kGlyphs[] = {
    {'A', "003960 1353"},
    {'B', "00095968665505 5564615000"},
    {'C', "6749290702204062"},
    {'D', "00093966633000"},
    {'E', "69090060 0545"},
    {'F', "690900 0545"},
    {'G', "67492907022040626434"},
    {'H', "0900 0565 6960"},
    {'I', "0900"},
    {'J', "5952302002"},
    {'K', "0900 6903 2560"},
    {'L', "090050"},
    {'M', "0009448980"},
    {'N', "00096069"},
    {'O', "290702204062674929"},
    {'P', "00095968655404"},
    {'Q', "290702204062674929 3360"},
    {'R', "00095968655404 3460"},
    {'S', "674929070625446362402002"},
    {'T', "0969 3930"},
    {'U', "090220406269"},
    {'V', "093069"},
    {'W', "0920466089"},
    {'X', "0960 6900"},
    {'Y', "093569 3530"},
    {'Z', "09690060"},
    {'0', "290702203052573929"},
    {'1', "072920"},
    {'2', "07294967650060"},
    {'3', "096935456362402002"},
    {'4', "40490363"},
    {'5', "590905456362402002"},
    {'6', "674929070220406263452503"},
    {'7', "096920"},
    {'8', "25072949674563624020020325 2545"},
    {'9', "022040626749290706244466"},
};

const Glyph* find_glyph(char c) {
  const char letter = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  for (const Glyph& glyph : kGlyphs) {
    if (glyph.letter == letter) return &glyph;
  }
  return nullptr;
}

/// The character that begins at `at`, all its bytes where it is UTF-8.
std::string character_at(std::string_view text, std::size_t at) {
  std::size_t end = at + 1;
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) ++end;
  return std::string(text.substr(at, end - at));
}

/// Adds the strokes of `glyph`, moved by `x` on the grid; returns its width.
double add_glyph(std::vector<Stroke>& strokes, const Glyph& glyph, double x, double scale) {
  double width = 0;
  strokes.emplace_back();
  for (const char* c = glyph.strokes; *c != '\0';) {
    if (*c == ' ') {
      strokes.emplace_back();
      ++c;
      continue;
    }
    const double column = c[0] - '0', row = c[1] - '0';
    strokes.back().emplace_back((x + column) * scale, row * scale);
    width = std::max(width, column);
    c += 2;
  }
  return width;
}

}  // namespace

Result<std::vector<Stroke>> letter_strokes(std::string_view text, double height) {
  if (!std::isfinite(height) || height <= 0) {
    return fail(Errc::bad_input, mjarm::text(msg::path_letter_height, height));
  }
  std::vector<Stroke> strokes;
  double x = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == ' ') {
      x += kSpace + kGap;
      continue;
    }
    const Glyph* glyph = find_glyph(text[i]);
    if (glyph == nullptr) {
      return fail(Errc::bad_input, mjarm::text(msg::path_letter_unknown, character_at(text, i)));
    }
    x += add_glyph(strokes, *glyph, x, height / kHeight) + kGap;
  }
  if (strokes.empty()) {
    return fail(Errc::bad_input, mjarm::text(msg::path_letters_empty, std::string(text)));
  }
  return strokes;
}

}  // namespace mjarm
