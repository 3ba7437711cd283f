#pragma once

#include <string>
#include <utility>
#include <vector>

namespace mjarm::app {

/// What the help of a command tells.
struct HelpPage {
  /// What is written, and what it means.
  using Row = std::pair<std::string, std::string>;

  std::string name;  ///< with the commands above it: "mjarm model info"
  std::string summary;
  std::string examples;  ///< may be empty
  std::vector<Row> commands = {}, arguments = {}, options = {};
  bool is_program = false;  ///< nothing stands above it
};

/// The help in the language in use: usage, summary, commands or options, examples.
[[nodiscard]] std::string help_text(const HelpPage& page);

}  // namespace mjarm::app
