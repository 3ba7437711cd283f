#pragma once

#include <string>
#include <vector>

namespace mjarm::app {

/// Rows of equally many cells with their columns aligned, a line each, indented by two blanks.
[[nodiscard]] std::string aligned(const std::vector<std::vector<std::string>>& rows);

/// Rows as a table in Markdown, aligned, so that it also reads well on a terminal; the first row is
/// the heading, later ones may be shorter.
[[nodiscard]] std::string markdown_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace mjarm::app
