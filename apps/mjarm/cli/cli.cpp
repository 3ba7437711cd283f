#include "apps/mjarm/cli/cli.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <utility>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/version.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/os_program.hpp"
#include "mjarm/core/program_name.hpp"

namespace mjarm::app {
namespace {

struct GlobalOptions {
  std::string language;
  bool verbose = false;
  bool quiet = false;
  bool version = false;
};

/// The value of `--lang`, read before everything else: the help itself is in that language.
std::optional<std::string> find_language(const std::vector<std::string>& arguments) {
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "--lang" && i + 1 < arguments.size()) return arguments[i + 1];
    if (arguments[i].rfind("--lang=", 0) == 0) return arguments[i].substr(7);
  }
  return std::nullopt;
}

Result<void> choose_language(const std::vector<std::string>& arguments) {
  set_language(language_of_locale());
  const std::optional<std::string> name = find_language(arguments);
  if (!name) return {};
  const std::vector<std::string> known = {"en", "zh-CN"};
  const bool chinese = *name == "zh-CN" || *name == "zh" || *name == "zh_CN";
  if (!chinese && *name != "en") {
    return fail(Errc::usage, text(msg::app_unknown_language, *name) + did_you_mean(*name, known));
  }
  set_language(chinese ? Language::chinese : Language::english);
  return {};
}

/// ./dev says by the environment that it is what the user typed.
void choose_program_name() {
  const std::optional<std::string> name = environment("MJARM_CALLED_AS");
  if (!name || name->empty()) return;
  set_program_name(*name, {
#define MJARM_COMMAND(name) #name,
#include "apps/mjarm/commands/commands.inc"
#undef MJARM_COMMAND
                              "bench", "COMMAND", "命令", "--help"});
}

/// A value such as `-.5` begins like a short option; `-0.5` does not.
std::vector<std::string> with_plain_numbers(std::vector<std::string> arguments) {
  for (std::string& argument : arguments) {
    const bool bare_point = argument.size() > 2 && argument[0] == '-' && argument[1] == '.' &&
                            argument[2] >= '0' && argument[2] <= '9';
    if (bare_point) argument.insert(1, "0");
  }
  return arguments;
}

void add_global_options(CLI::App& app, GlobalOptions& options) {
  add_option(app, "--lang", options.language, msg::app_option_lang, "en|zh-CN");
  add_flag(app, "-v,--verbose", options.verbose, msg::app_option_verbose);
  add_flag(app, "--quiet", options.quiet, msg::app_option_quiet);
  add_flag(app, "--version", options.version, msg::app_option_version);
}

/// The command that the arguments begin with, where another program does it.
const Command* handed_over(std::span<const Command> commands,
                           const std::vector<std::string>& arguments) {
  const std::size_t word = command_word(arguments);
  if (word == arguments.size()) return nullptr;
  const auto found = std::ranges::find(commands, arguments[word], &Command::name);
  return found != commands.end() && found->program != nullptr ? &*found : nullptr;
}

/// Returns only where the other program cannot be started.
Error go_on(const Command& command, const std::vector<std::string>& arguments) {
  const Result<std::filesystem::path> self = executable_path();
  if (!self) return self.error();
  const std::filesystem::path program = self->parent_path() / command.program;
  std::error_code code;
  if (std::filesystem::exists(program, code)) return become_program(program, arguments);
  return {Errc::not_available, text(msg::app_no_program, command.name, program.string())};
}

/// @return the exit code.
int report(const Error& error) {
  log_error(error.what);
  return error.code == Errc::bad_input || error.code == Errc::usage ? 2 : 1;
}

/// Results must have reached their reader before 0 is returned.
int finish(int code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  return report({Errc::system, text(msg::core_cannot_write, "stdout", system_message(errno))});
}

int run_parsed(const CLI::App& app, const GlobalOptions& global,
               const std::vector<std::pair<const CLI::App*, Run>>& runs) {
  if (global.quiet && global.verbose) {
    return report({Errc::usage, text(msg::app_exclusive_options, "--quiet", "--verbose")});
  }
  if (global.quiet) set_log_level(LogLevel::error);
  if (global.verbose) set_log_level(LogLevel::debug);
  if (global.version) {
    std::printf("%s\n", version_line().c_str());
    return finish(0);
  }
  for (const auto& [command, run] : runs) {
    if (!is_called(*command)) continue;
    const Result<int> code = run();
    return code ? finish(*code) : report(code.error());
  }
  std::fputs(help_of(app).c_str(), stdout);
  return report({Errc::usage, text(msg::app_no_command)});
}

int run_guarded(std::span<const Command> commands, const std::vector<std::string>& arguments) {
  choose_program_name();
  if (const Result<void> chosen = choose_language(arguments); !chosen) {
    return report(chosen.error());
  }
  if (const Command* other = handed_over(commands, arguments)) {
    return report(go_on(*other, arguments));
  }
  catch_interrupts();
  const AppPtr app = make_program(program_name(), msg::app_summary, msg::app_examples);
  GlobalOptions global;
  add_global_options(*app, global);
  std::vector<std::pair<const CLI::App*, Run>> runs;
  for (const Command& command : commands) {
    CLI::App& sub = add_subcommand(*app, command.name, command.summary, command.examples);
    if (command.setup != nullptr) runs.emplace_back(&sub, command.setup(sub));
  }
  const Result<bool> parsed = parse(*app, with_plain_numbers(arguments));
  if (!parsed) return report(parsed.error());
  if (*parsed) return run_parsed(*app, global, runs);
  std::fputs(help_of(*app).c_str(), stdout);
  return finish(0);
}

}  // namespace

std::size_t command_word(const std::vector<std::string>& arguments) noexcept {
  std::size_t i = 0;
  while (i < arguments.size() && arguments[i].starts_with('-'))
    i += arguments[i] == "--lang" ? 2 : 1;
  return std::min(i, arguments.size());
}

int run(std::span<const Command> commands, const std::vector<std::string>& arguments) noexcept {
  try {
    return run_guarded(commands, arguments);
  } catch (const std::exception& error) {
    // Nothing of ours throws; what comes here is memory that ran out, or a fault of ours.
    return report({Errc::impossible, text(msg::app_internal_error, error.what())});
  }
}

}  // namespace mjarm::app
