#pragma once

#include <string>
#include <vector>

namespace mjarm::app {

/// Rows of equally many cells with their columns aligned, a line each, indented by two blanks.
[[nodiscard]] std::string aligned(const std::vector<std::vector<std::string>>& rows);

}  // namespace mjarm::app
