#include "mjarm/path/hanzi.hpp"

#include <charconv>
#include <optional>
#include <string_view>

#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/path.hpp"
#include "mjarm/core/user_data.hpp"

namespace mjarm {
namespace {

/// The part of `text` up to `mark`, which is taken from its front; none where nothing is left.
std::optional<std::string_view> next_part(std::string_view& text, char mark) {
  if (text.empty()) return std::nullopt;
  const std::size_t end = std::min(text.find(mark), text.size());
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return part;
}

std::optional<double> whole_number(std::string_view word) {
  int value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

/// The strokes of one character; none where they are not written as they should be.
std::optional<std::vector<Stroke>> strokes_of(std::string_view line) {
  std::vector<Stroke> strokes;
  while (const auto part = next_part(line, ';')) {
    std::string_view points = *part;
    Stroke stroke{.points = {}, .smooth = true};
    while (const auto point = next_part(points, ' ')) {
      std::string_view numbers = *point;
      const auto x = whole_number(next_part(numbers, ',').value_or(""));
      const auto y = whole_number(numbers);
      if (!x || !y) return std::nullopt;
      const Eigen::Vector2d p(*x / kHanziSquare, (*y + kHanziBelow) / kHanziSquare);
      // A point that stands twice, or near the one before, has no direction.
      constexpr double kNear = 2 / kHanziSquare;
      if (stroke.points.empty() || (p - stroke.points.back()).norm() > kNear) {
        stroke.points.push_back(p);
      }
    }
    if (stroke.points.size() < 2) return std::nullopt;
    strokes.push_back(std::move(stroke));
  }
  if (strokes.empty()) return std::nullopt;
  return strokes;
}

}  // namespace

Result<std::filesystem::path> hanzi_file() {
  return data_folder().transform([](const auto& data) { return data / "hanzi" / "strokes.txt"; });
}

Result<std::map<std::string, std::vector<Stroke>>> hanzi_strokes(
    const std::filesystem::path& file, const std::set<std::string>& characters) {
  constexpr std::size_t kMaxBytes = std::size_t{1} << 26;
  const Result<std::string> content = read_file(file, kMaxBytes);
  if (!content) return fail(content.error());
  std::map<std::string, std::vector<Stroke>> found;
  std::string_view rest = *content;
  for (int number = 1; const auto line = next_part(rest, '\n'); ++number) {
    std::string_view strokes = *line;
    const std::string character(next_part(strokes, ' ').value_or(""));
    if (!characters.contains(character)) continue;
    std::optional<std::vector<Stroke>> read = strokes_of(strokes);
    if (!read) return fail(Errc::bad_input, text(msg::path_hanzi_line, file.string(), number));
    found.insert_or_assign(character, std::move(*read));
  }
  return found;
}

}  // namespace mjarm
