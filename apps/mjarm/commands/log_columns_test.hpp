#pragma once

#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/run_program.hpp"

namespace mjarm::app {

/// The columns of numbers of a log by their headings.
using Columns = std::map<std::string, std::vector<double>>;

inline Columns columns_of(const std::string& csv) {
  const std::vector<std::string> lines = support::lines_of(csv);
  std::vector<std::string> headings;
  std::stringstream first(lines.at(0));
  for (std::string cell; std::getline(first, cell, ',');) headings.push_back(cell);
  Columns out;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    std::stringstream row(lines[i]);
    std::string cell;
    for (std::size_t k = 0; std::getline(row, cell, ','); ++k) {
      if (headings.at(k) != "contacts") out[headings[k]].push_back(std::stod(cell));
    }
  }
  return out;
}

}  // namespace mjarm::app
