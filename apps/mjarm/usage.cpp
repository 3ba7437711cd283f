#include "apps/mjarm/usage.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <vector>

#include "mjarm/core/messages/app.hpp"
#include "mjarm/core/nearest_word.hpp"

namespace mjarm::app {
namespace {

/// The innermost subcommand that was called, else the program itself.
const CLI::App& innermost(const CLI::App& app) {
  const std::vector<CLI::App*> called = app.get_subcommands();
  return called.empty() ? app : innermost(*called.back());
}

std::vector<std::string> subcommand_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(sub->get_name());
  }
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

std::string full_name(const CLI::App& app) {
  return app.get_parent() == nullptr ? app.get_name()
                                     : full_name(*app.get_parent()) + " " + app.get_name();
}

}  // namespace

Error usage_error(const CLI::ParseError& error) {
  const std::string what = error.what();
  if (error.get_name() == "ArgumentMismatch") {
    const std::string option = what.substr(0, what.find(':'));
    const bool repeated = what.find("received") != std::string::npos;
    return {Errc::usage, repeated ? text(msg::app_option_once, option)
                                  : text(msg::app_option_needs_value, option)};
  }
  return {Errc::usage, text(msg::app_bad_usage, what)};
}

std::optional<Error> unknown_words(const CLI::App& app) {
  const std::vector<std::string> unknown = app.remaining(true);
  if (unknown.empty()) return std::nullopt;
  const CLI::App& called = innermost(app);
  // An option explains more than the values that were meant for it.
  for (const std::string& word : unknown) {
    if (word.size() < 2 || word[0] != '-') continue;
    const std::string name = word.substr(0, word.find('='));
    return Error{Errc::usage,
                 text(msg::app_unknown_option, name) + did_you_mean(name, option_names(&called))};
  }
  const std::string& word = unknown.front();
  const std::vector<std::string> known = subcommand_names(called);
  if (!known.empty()) {
    return Error{Errc::usage, text(msg::app_unknown_command, word, full_name(called)) +
                                  did_you_mean(word, known)};
  }
  return Error{Errc::usage, text(msg::app_unexpected_word, word, full_name(called))};
}

Result<std::uint64_t> parse_whole(const std::string& option, const std::string& value) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (error != std::errc() || end != value.data() + value.size()) {
    return fail(Errc::usage, text(msg::app_not_whole, option, value));
  }
  return number;
}

Result<std::size_t> parse_choice(const std::string& option, const std::string& value,
                                 std::span<const std::string> words) {
  const auto word = std::find(words.begin(), words.end(), value);
  if (word != words.end()) return static_cast<std::size_t>(word - words.begin());
  std::string list;
  for (const std::string& known : words) list += (list.empty() ? "" : ", ") + known;
  return fail(Errc::usage,
              text(msg::app_unknown_choice, option, value, did_you_mean(value, words), list));
}

Result<std::vector<double>> parse_list(const std::string& option, const std::string& value,
                                       Quantity quantity, std::size_t size) {
  if (value.empty()) return fail(Errc::usage, text(msg::app_option_missing, option));
  Result<std::vector<double>> values = parse_quantities(value, quantity);
  if (!values) return fail(in_option(option, std::move(values.error())));
  if (values->size() != size) {
    return fail(Errc::usage, text(msg::app_wrong_count, option, size, values->size()));
  }
  return values;
}

Result<std::vector<double>> parse_joints(const std::string& option, const std::string& value,
                                         const Arm& arm) {
  const std::vector<std::string_view> words = split_list(value);
  const auto dof = static_cast<std::size_t>(arm.dof());
  if (words.size() != dof) {
    return fail(Errc::usage, text(msg::app_wrong_count, option, dof, words.size()));
  }
  std::vector<double> q;
  for (std::size_t i = 0; i < dof; ++i) {
    const bool hinge = arm.joints[i].type == JointType::hinge;
    Result<double> joint = parse_quantity(words[i], hinge ? Quantity::angle : Quantity::length);
    if (!joint) return fail(in_option(option, std::move(joint.error())));
    q.push_back(*joint);
  }
  return q;
}

Error in_option(const std::string& option, Error error) {
  error.what = option + ": " + error.what;
  return error;
}

}  // namespace mjarm::app
