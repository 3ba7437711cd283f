#include "mjarm/path/letters.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "mjarm/core/messages/path.hpp"
#include "mjarm/core/utf8.hpp"
#include "mjarm/path/hanzi.hpp"

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

const Glyph* find_glyph(std::string_view character) {
  if (character.size() != 1) return nullptr;
  const char c = character[0];
  const char letter = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  for (const Glyph& glyph : kGlyphs) {
    if (glyph.letter == letter) return &glyph;
  }
  return nullptr;
}

/// The characters of `text`, bytes that are no UTF-8 one by one.
std::vector<std::string> characters_of(std::string_view text) {
  std::vector<std::string> out;
  while (!text.empty()) {
    const std::size_t length = std::max<std::size_t>(utf8_length(text), 1);
    out.emplace_back(text.substr(0, length));
    text.remove_prefix(length);
  }
  return out;
}

constexpr std::string_view kWideSpace = "\xE3\x80\x80";  // U+3000, as wide as a Chinese character

/// The strokes of one character, the lower left corner of its place at (0, 0).
struct Written {
  std::vector<Stroke> strokes;
  double advance = 0;  ///< to where the next one begins
};

Written written(const Glyph& glyph, double height) {
  const double scale = height / kHeight;
  Written out{{{}}, 0};
  for (const char* c = glyph.strokes; *c != '\0';) {
    if (*c == ' ') {
      out.strokes.emplace_back();
      ++c;
      continue;
    }
    const double column = c[0] - '0', row = c[1] - '0';
    out.strokes.back().points.emplace_back(column * scale, row * scale);
    out.advance = std::max(out.advance, (column + kGap) * scale);
    c += 2;
  }
  return out;
}

Written written(std::vector<Stroke> square, double height) {
  for (Stroke& stroke : square) {
    for (Eigen::Vector2d& p : stroke.points) p *= height;
  }
  return {std::move(square), height};
}

/// Of the characters that are no letters.
Result<std::map<std::string, std::vector<Stroke>>> fetched(const std::set<std::string>& others) {
  if (others.empty()) return {};
  const Result<std::filesystem::path> file = hanzi_file();
  std::error_code ignored;
  if (file && std::filesystem::exists(*file, ignored)) return hanzi_strokes(*file, others);
  const auto chinese = std::ranges::find_if(others, [](const auto& c) { return c.size() > 2; });
  if (chinese == others.end()) return {};
  return fail(Errc::not_available, text(msg::path_hanzi_not_installed, *chinese));
}

}  // namespace

Result<std::vector<Stroke>> letter_strokes(std::string_view text, double height) {
  if (!std::isfinite(height) || height <= 0) {
    return fail(Errc::bad_input, mjarm::text(msg::path_letter_height, height));
  }
  const std::vector<std::string> characters = characters_of(text);
  const auto is_blank = [](const std::string& c) { return c == " " || c == kWideSpace; };
  std::set<std::string> others;
  for (const std::string& c : characters) {
    if (!is_blank(c) && find_glyph(c) == nullptr) others.insert(c);
  }
  const auto known = fetched(others);
  if (!known) return fail(known.error());

  std::vector<Stroke> strokes;
  double x = 0;
  for (const std::string& c : characters) {
    if (is_blank(c)) {
      x += c == " " ? (kSpace + kGap) * height / kHeight : height;
      continue;
    }
    const Glyph* glyph = find_glyph(c);
    const auto other = known->find(c);
    if (glyph == nullptr && other == known->end()) {
      return fail(Errc::bad_input, mjarm::text(msg::path_letter_unknown, printable(c)));
    }
    Written one = glyph != nullptr ? written(*glyph, height) : written(other->second, height);
    for (Stroke& stroke : one.strokes) {
      for (Eigen::Vector2d& p : stroke.points) p.x() += x;
      strokes.push_back(std::move(stroke));
    }
    x += one.advance;
  }
  if (strokes.empty()) {
    return fail(Errc::bad_input, mjarm::text(msg::path_letters_empty, std::string(text)));
  }
  return strokes;
}

}  // namespace mjarm
