#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mjarm/core/messages.hpp"
#include "mjarm/core/result.hpp"

namespace CLI {
class App;
}  // namespace CLI

namespace mjarm {
struct Replace;
}  // namespace mjarm

/// Commands and their options without the headers of CLI11, which take many seconds to compile:
/// only options.cpp includes them.
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
/// Adds `--overwrite`, beside the `--out` of a command whose results may take long.
void add_overwrite_option(CLI::App& app, Replace& replace);

/// Adds a subcommand with its help to `parent` (a command may have some of its own).
CLI::App& add_subcommand(CLI::App& parent, const std::string& name, Msg summary, Msg examples);
/// True where this subcommand was called.
[[nodiscard]] bool is_called(const CLI::App& app);
[[nodiscard]] std::string name_of(const CLI::App& app);

/// The program itself, which has `--help` and no other option or command yet.
struct AppDeleter {
  void operator()(CLI::App* app) const;
};
using AppPtr = std::unique_ptr<CLI::App, AppDeleter>;
[[nodiscard]] AppPtr make_program(const std::string& name, Msg summary, Msg examples);

/// Reads the command line.
/// @return false where help was asked for, and a usage error, with the nearest right word, where
/// something in it is unknown or out of place.
[[nodiscard]] Result<bool> parse(CLI::App& program, std::vector<std::string> arguments);

/// The help of the command that was called, or of the program.
[[nodiscard]] std::string help_of(const CLI::App& program);

}  // namespace mjarm::app
