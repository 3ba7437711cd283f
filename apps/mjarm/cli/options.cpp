#include "apps/mjarm/cli/options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>
#include <utility>

#include "apps/mjarm/cli/help.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/long_result.hpp"
#include "mjarm/core/nearest_word.hpp"

namespace mjarm::app {
namespace {

std::vector<const CLI::App*> subcommands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::string full_name(const CLI::App& app) {
  return app.get_parent() == nullptr ? app.get_name()
                                     : full_name(*app.get_parent()) + " " + app.get_name();
}

/// "-h, --help", "--out FILE", or, of an argument, "FILE".
std::string option_label(const CLI::Option& option) {
  if (option.get_positional()) return option.get_type_name();
  std::string label;
  for (const std::string& name : option.get_snames()) label += "-" + name + ", ";
  for (const std::string& name : option.get_lnames()) label += "--" + name + ", ";
  label.resize(label.size() - 2);
  const bool takes_value = option.get_type_size() > 0;
  return takes_value ? label + " " + option.get_type_name() : label;
}

class HelpFormatter final : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* app, std::string, CLI::AppFormatMode) const override {
    HelpPage page{.name = full_name(*app),
                  .summary = app->get_description(),
                  .examples = app->get_footer(),
                  .is_program = app->get_parent() == nullptr};
    for (const CLI::App* sub : subcommands(*app)) {
      page.commands.emplace_back(sub->get_name(), sub->get_description());
    }
    for (const CLI::Option* option : app->get_options()) {
      (option->get_positional() ? page.arguments : page.options)
          .emplace_back(option_label(*option), option->get_description());
    }
    return help_text(page);
  }
};

/// The innermost subcommand that was called, else the program itself.
const CLI::App& innermost(const CLI::App& app) {
  const std::vector<CLI::App*> called = app.get_subcommands();
  return called.empty() ? app : innermost(*called.back());
}

std::vector<std::string> subcommand_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : subcommands(app)) names.push_back(sub->get_name());
  return names;
}

/// Names of the options of `app` and of everything above it, with their dashes.
std::vector<std::string> option_names(const CLI::App* app) {
  std::vector<std::string> names;
  for (; app != nullptr; app = app->get_parent()) {
    for (const CLI::Option* option : app->get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
      for (const std::string& name : option->get_snames()) names.push_back("-" + name);
    }
  }
  return names;
}

/// The option that the parser's words are about; empty where they name none.
std::string option_in(const std::string& words) {
  const std::size_t begin = words.find("--");
  if (begin == std::string::npos) return {};
  return words.substr(begin, words.find_first_of(" :=,", begin) - begin);
}

/// What the parser complains about, as one line of ours.
Error usage_error(const CLI::ParseError& error) {
  const std::string what = error.what();
  // Values of options are text to the parser; what it can convert or not is a flag's.
  const bool of_flag = error.get_name() == "ConversionError" || error.get_name() == "InvalidError";
  if (const std::string flag = option_in(what); of_flag && !flag.empty()) {
    return {Errc::usage, text(msg::app_flag_value, flag)};
  }
  if (error.get_name() == "ArgumentMismatch") {
    const std::string option = what.substr(0, what.find(':'));
    const bool repeated = what.find("received") != std::string::npos;
    return {Errc::usage, repeated ? text(msg::app_option_once, option)
                                  : text(msg::app_option_needs_value, option)};
  }
  return {Errc::usage, text(msg::app_bad_usage, what)};
}

bool is_option(const std::string& word) { return word.size() >= 2 && word[0] == '-'; }

/// An option that took the one after it for its value, because its own was left out.
std::optional<Error> missing_value(const CLI::App& app) {
  const std::vector<std::string> known = option_names(&innermost(app));
  const auto is_known = [&](const std::string& word) {
    return std::ranges::find(known, word.substr(0, word.find('='))) != known.end();
  };
  for (const CLI::App* at = &innermost(app); at != nullptr; at = at->get_parent()) {
    for (const CLI::Option* option : at->get_options()) {
      if (option->get_positional() || option->get_type_size() == 0) continue;
      if (std::ranges::none_of(option->results(), is_known)) continue;
      return Error{Errc::usage, text(msg::app_option_needs_value, option->get_name())};
    }
  }
  return std::nullopt;
}

/// The first word of the parsed command line that nothing knows, with the nearest right one.
/// @param literal  what stands after "--": nothing there is an option, whatever it looks like.
std::optional<Error> unknown_words(const CLI::App& app, const std::vector<std::string>& literal) {
  const std::vector<std::string> unknown = app.remaining(true);
  if (unknown.empty()) return std::nullopt;
  const CLI::App& called = innermost(app);
  const std::vector<std::string> commands = subcommand_names(called);
  const auto unknown_command = [&](const std::string& word) {
    return Error{Errc::usage, text(msg::app_unknown_command, word, full_name(called)) +
                                  did_you_mean(word, commands)};
  };
  // Of a command that is not known the options are not known either.
  if (!commands.empty() && !is_option(unknown.front())) return unknown_command(unknown.front());
  // An option explains more than the values that were meant for it.
  const std::vector<std::string> options = option_names(&called);
  for (const std::string& word : unknown) {
    if (!is_option(word) || word == "--") continue;
    const std::string name = word.substr(0, word.find('='));
    if (std::ranges::find(literal, word) != literal.end()) {
      return Error{Errc::usage, text(msg::app_unexpected_word, word, full_name(called))};
    }
    return Error{Errc::usage, text(msg::app_unknown_option, name) + did_you_mean(name, options)};
  }
  const auto word = std::ranges::find_if(unknown, [](const auto& it) { return it != "--"; });
  if (word == unknown.end()) return std::nullopt;
  if (!commands.empty()) return unknown_command(*word);
  return Error{Errc::usage, text(msg::app_unexpected_word, *word, full_name(called))};
}

}  // namespace

void add_option(CLI::App& app, const char* name, std::string& value, Msg help, const char* type) {
  app.add_option(name, value, text(help))->type_name(type);
}

void add_option(CLI::App& app, const char* name, std::string& value, Msg help, const char* type,
                const char* bare) {
  app.add_option(name, value, text(help))->type_name(type)->expected(0, 1)->default_str(bare);
}

void add_option(CLI::App& app, const char* name, std::vector<std::string>& values, Msg help,
                const char* type) {
  app.add_option(name, values, text(help))->type_name(type)->allow_extra_args(false)->take_all();
}

void add_flag(CLI::App& app, const char* name, bool& value, Msg help) {
  app.add_flag(name, value, text(help));
}

void add_overwrite_option(CLI::App& app, Replace& replace) {
  add_flag(app, "--overwrite", replace.overwrite, msg::app_option_overwrite);
}

CLI::App& add_subcommand(CLI::App& parent, const std::string& name, Msg summary, Msg examples) {
  CLI::App& app = *parent.add_subcommand(name, text(summary));
  app.footer(text(examples));
  app.allow_extras();  // what is not known is reported by us, with the nearest right word
  app.fallthrough();   // global options may stand anywhere
  app.require_subcommand(0, 1);
  return app;
}

bool is_called(const CLI::App& app) { return app.parsed(); }

std::string name_of(const CLI::App& app) { return app.get_name(); }

void AppDeleter::operator()(CLI::App* app) const { delete app; }

AppPtr make_program(const std::string& name, Msg summary, Msg examples) {
  AppPtr program(new CLI::App(text(summary), name));
  program->formatter(std::make_shared<HelpFormatter>());
  program->footer(text(examples));
  program->allow_extras();
  program->require_subcommand(0, 1);
  program->set_help_flag("-h,--help", text(msg::app_option_help));
  return program;
}

Result<bool> parse(CLI::App& program, std::vector<std::string> arguments) {
  const std::vector<std::string> literal(std::ranges::find(arguments, "--"), arguments.end());
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
  try {
    program.parse(std::move(arguments));
  } catch (const CLI::CallForHelp&) {
    return false;
  } catch (const CLI::ParseError& error) {
    return fail(usage_error(error));
  }
  if (const std::optional<Error> error = missing_value(program)) return fail(*error);
  if (const std::optional<Error> error = unknown_words(program, literal)) return fail(*error);
  return true;
}

std::string help_of(const CLI::App& program) { return program.help(); }

}  // namespace mjarm::app
