#include "apps/mjarm/cli/help.hpp"

#include <algorithm>

#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/text_width.hpp"

namespace mjarm::app {
namespace {

/// "  name   description" with all descriptions in one column.
std::string table(const std::vector<HelpPage::Row>& rows) {
  int width = 0;
  for (const auto& [name, description] : rows) width = std::max(width, text_width(name));
  std::string result;
  for (const auto& [name, description] : rows) {
    result += "  " + padded(name, width + 2) + description + "\n";
  }
  return result;
}

std::string usage(const HelpPage& page) {
  std::string line = text(msg::app_help_usage) + page.name;
  if (!page.commands.empty()) line += " " + text(msg::app_help_command);
  for (const auto& [name, description] : page.arguments) line += " " + name;
  return line + " " + text(msg::app_help_options) + "\n";
}

}  // namespace

std::string help_text(const HelpPage& page) {
  std::string result = page.summary + "\n\n" + usage(page);
  if (!page.commands.empty()) {
    result += "\n" + text(msg::app_help_commands) + "\n" + table(page.commands);
  }
  std::vector<HelpPage::Row> rows = page.arguments;
  rows.insert(rows.end(), page.options.begin(), page.options.end());
  result += "\n" + text(msg::app_help_option_list) + "\n" + table(rows);
  if (!page.is_program) result += text(msg::app_help_global) + "\n";
  if (!page.examples.empty()) {
    result += "\n" + text(msg::app_help_examples) + "\n" + page.examples + "\n";
  }
  return result;
}

}  // namespace mjarm::app
