#include "apps/mjarm/cli/table.hpp"

#include <algorithm>

#include "mjarm/core/text_width.hpp"

namespace mjarm::app {
namespace {

std::vector<int> column_widths(const std::vector<std::vector<std::string>>& rows) {
  std::vector<int> widths;
  for (const std::vector<std::string>& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], text_width(row[i]));
    }
  }
  return widths;
}

}  // namespace

std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  const std::vector<int> widths = column_widths(rows);
  std::string result;
  for (const auto& row : rows) {
    std::string line = " ";
    for (std::size_t i = 0; i < row.size(); ++i) line += " " + padded(row[i], widths[i] + 1);
    line.erase(line.find_last_not_of(' ') + 1);
    result += line + "\n";
  }
  return result;
}

std::string markdown_table(const std::vector<std::vector<std::string>>& rows) {
  const std::vector<int> widths = column_widths(rows);
  std::string out;
  for (const std::vector<std::string>& row : rows) {
    out += '|';
    for (std::size_t i = 0; i < row.size(); ++i) out += " " + padded(row[i], widths[i]) + " |";
    out += '\n';
    if (&row != rows.data()) continue;
    for (const int width : widths) {
      out += "|" + std::string(static_cast<std::size_t>(width) + 2, '-');
    }
    out += "|\n";
  }
  return out;
}

}  // namespace mjarm::app
