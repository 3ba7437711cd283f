#include "apps/mjarm/help.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "mjarm/core/messages/app.hpp"
#include "mjarm/core/text_width.hpp"

namespace mjarm::app {
namespace {

using Rows = std::vector<std::pair<std::string, std::string>>;

/// "  name   description" with all descriptions in one column.
std::string table(const Rows& rows) {
  int width = 0;
  for (const auto& [name, description] : rows) width = std::max(width, text_width(name));
  std::string result;
  for (const auto& [name, description] : rows) {
    result += "  " + padded(name, width + 2) + description + "\n";
  }
  return result;
}

std::string option_label(const CLI::Option& option) {
  std::string label;
  for (const std::string& name : option.get_snames()) label += "-" + name + ", ";
  for (const std::string& name : option.get_lnames()) label += "--" + name + ", ";
  label.resize(label.size() - 2);
  const bool takes_value = option.get_type_size() > 0;
  return takes_value ? label + " " + option.get_type_name() : label;
}

Rows option_rows(const CLI::App& app) {
  Rows rows;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) {
      rows.emplace_back(option->get_type_name(), option->get_description());
    }
  }
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_positional()) {
      rows.emplace_back(option_label(*option), option->get_description());
    }
  }
  return rows;
}

Rows command_rows(const CLI::App& app) {
  Rows rows;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    rows.emplace_back(sub->get_name(), sub->get_description());
  }
  return rows;
}

std::string full_name(const CLI::App& app) {
  return app.get_parent() == nullptr ? app.get_name()
                                     : full_name(*app.get_parent()) + " " + app.get_name();
}

std::string usage(const CLI::App& app, bool has_commands) {
  std::string line = text(msg::app_help_usage) + full_name(app);
  if (has_commands) line += " " + text(msg::app_help_command);
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) line += " " + option->get_type_name();
  }
  return line + " " + text(msg::app_help_options) + "\n";
}

}  // namespace

std::string HelpFormatter::make_help(const CLI::App* app, std::string, CLI::AppFormatMode) const {
  const Rows commands = command_rows(*app);
  std::string result = app->get_description() + "\n\n" + usage(*app, !commands.empty());
  if (!commands.empty()) result += "\n" + text(msg::app_help_commands) + "\n" + table(commands);
  result += "\n" + text(msg::app_help_option_list) + "\n" + table(option_rows(*app));
  if (app->get_parent() != nullptr) result += text(msg::app_help_global) + "\n";
  if (!app->get_footer().empty()) {
    result += "\n" + text(msg::app_help_examples) + "\n" + app->get_footer() + "\n";
  }
  return result;
}

}  // namespace mjarm::app
