#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace mjarm::app {

/// Writes the help of a command in the language in use: usage, summary, commands or options,
/// examples.
class HelpFormatter final : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
};

}  // namespace mjarm::app
