#pragma once

#include <string>
#include <vector>

#include "mjarm/core/messages.hpp"

namespace CLI {
class App;
}  // namespace CLI

/// Options of commands without the headers of CLI11, which take seconds to compile in every file.
namespace mjarm::app {

/// Adds an option with a value, or, where `name` has no dashes, an argument.
/// @param value  what is given ends there; its default shows in no help.
/// @param type   stands for the value in the help: "FILE".
void add_option(CLI::App& app, const char* name, std::string& value, Msg help, const char* type);
/// The same where the value may be left out: `bare` stands for it then.
void add_option(CLI::App& app, const char* name, std::string& value, Msg help, const char* type,
                const char* bare);
/// An option that may be given several times.
void add_option(CLI::App& app, const char* name, std::vector<std::string>& values, Msg help,
                const char* type);
void add_flag(CLI::App& app, const char* name, bool& value, Msg help);

/// Adds a subcommand with its help to `parent` (a command may have some of its own).
CLI::App& add_subcommand(CLI::App& parent, const std::string& name, Msg summary, Msg examples);
/// True where this subcommand was called.
[[nodiscard]] bool is_called(const CLI::App& app);
[[nodiscard]] std::string name_of(const CLI::App& app);

}  // namespace mjarm::app
