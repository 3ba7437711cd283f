#include "mjarm/core/csv.hpp"

#include <algorithm>

#include "mjarm/core/trim.hpp"

namespace mjarm {
namespace {

/// Takes the quoted field that `rest` begins with, and what stands between it and the next comma.
std::string take_quoted(std::string_view& rest) {
  std::string field;
  rest.remove_prefix(1);
  while (!rest.empty()) {
    const char c = rest.front();
    rest.remove_prefix(1);
    if (c != '"') {
      field += c;
    } else if (rest.starts_with('"')) {
      field += '"';
      rest.remove_prefix(1);
    } else {
      break;
    }
  }
  const std::size_t comma = std::min(rest.find(','), rest.size());
  field += rest.substr(0, comma);
  rest.remove_prefix(comma);
  return field;
}

constexpr std::string_view kBlanks = " \t";

}  // namespace

std::string csv_field(const std::string& words) {
  if (words.find_first_of(",\"\n\r") == std::string::npos) return words;
  std::string quoted = "\"";
  for (const char c : words) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::vector<std::string> csv_fields(std::string_view line) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
  std::vector<std::string> fields;
  for (;;) {
    line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
    if (line.starts_with('"')) {
      fields.emplace_back(trimmed(take_quoted(line), kBlanks));
    } else {
      const std::size_t comma = std::min(line.find(','), line.size());
      fields.emplace_back(trimmed(line.substr(0, comma), kBlanks));
      line.remove_prefix(comma);
    }
    if (line.empty()) return fields;
    line.remove_prefix(1);  // the comma
  }
}

}  // namespace mjarm
