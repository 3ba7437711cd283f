// Tables stand aligned on a terminal, whatever language their cells are in.
#include "apps/mjarm/cli/table.hpp"

#include <gtest/gtest.h>

#include "mjarm/core/text_width.hpp"
#include "tests/support/run_program.hpp"

namespace mjarm::app {
namespace {

using Rows = std::vector<std::vector<std::string>>;

/// Columns on the terminal before each `|` of a line.
std::vector<int> bars(const std::string& line) {
  std::vector<int> columns;
  for (std::size_t at = line.find('|'); at != std::string::npos; at = line.find('|', at + 1)) {
    columns.push_back(text_width(line.substr(0, at)));
  }
  return columns;
}

const Rows kMixed = {{"场景", "有效", "least clearance"},
                     {"bookshelf", "12", "0.1 mm"},
                     {"书架（小）", "3", "-"},
                     {"", "100000", "１２"}};

TEST(Table, BarsStandBelowEachOtherInAnyLanguage) {
  const std::vector<std::string> lines = support::lines_of(markdown_table(kMixed));
  ASSERT_EQ(lines.size(), kMixed.size() + 1);
  EXPECT_EQ(bars(lines.front()).size(), 4U);
  for (const std::string& line : lines) EXPECT_EQ(bars(line), bars(lines.front())) << line;
  EXPECT_EQ(lines[1].find_first_not_of("|-"), std::string::npos) << lines[1];
}

TEST(Table, CellsKeepTheirTextAndOrder) {
  const std::vector<std::string> lines = support::lines_of(markdown_table(kMixed));
  for (std::size_t row = 0; row < kMixed.size(); ++row) {
    const std::string& line = lines[row == 0 ? 0 : row + 1];
    std::size_t from = 0;
    for (const std::string& cell : kMixed[row]) {
      const std::size_t at = line.find("| " + cell, from);
      ASSERT_NE(at, std::string::npos) << cell << " in " << line;
      from = at + 1;
    }
  }
}

/// Where the second word of an indented line begins, in columns of a terminal.
int second_column(const std::string& line) {
  const std::size_t end = line.find("  ", line.find_first_not_of(' '));
  return text_width(line.substr(0, line.find_first_not_of(' ', end)));
}

TEST(Table, ColumnsWithoutBarsStandBelowEachOther) {
  const std::string text = aligned({{"within 5 cm", "100.0 %"}, {"5 厘米内", "3 %"}, {"总", "x"}});
  const std::vector<std::string> lines = support::lines_of(text);
  ASSERT_EQ(lines.size(), 3U);
  for (const std::string& line : lines) {
    EXPECT_EQ(line.substr(0, 2), "  ");
    EXPECT_EQ(second_column(line), second_column(lines.front())) << text;
    EXPECT_NE(line.back(), ' ');
  }
}

TEST(Table, EmptyTablesAndEmptyCellsAreNoTrouble) {
  EXPECT_EQ(aligned({}), "");
  EXPECT_EQ(markdown_table({}), "");
  EXPECT_EQ(support::lines_of(aligned({{"", ""}, {"a", ""}})).size(), 2U);
  // A row that is shorter ends earlier; one heading alone has its rule.
  const std::vector<std::string> lines = support::lines_of(markdown_table({{"a", "b"}, {"c"}}));
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(bars(lines[2]), (std::vector<int>{0, 4}));
  EXPECT_EQ(markdown_table({{"only"}}), "| only |\n|------|\n");
}

}  // namespace
}  // namespace mjarm::app
