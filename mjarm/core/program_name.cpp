#include "mjarm/core/program_name.hpp"

#include <algorithm>
#include <utility>

namespace mjarm {
namespace {

constexpr std::string_view kOwnName = "mjarm";

struct ProgramName {
  std::string name{kOwnName};
  std::string in_patterns = name;  ///< its braces doubled
  std::vector<std::string> commands = {};
};
ProgramName& the_program() {
  static auto* program = new ProgramName;
  return *program;
}

bool is_of_a_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// Whether "mjarm" stands at `at`, by itself and before a command.
bool is_command(std::string_view text, std::size_t at) {
  if (at == 0 || is_of_a_word(text[at - 1]) || text[at - 1] == '/') return false;
  const std::string_view after = text.substr(at + kOwnName.size());
  if (!after.starts_with(' ')) return false;
  return std::ranges::any_of(the_program().commands, [&](const std::string& command) {
    const std::string_view rest = after.substr(1);
    const bool whole = rest.size() <= command.size() || !is_of_a_word(rest[command.size()]);
    return whole && rest.starts_with(command);
  });
}

}  // namespace

void set_program_name(std::string name, std::vector<std::string> commands) {
  std::string in_patterns;
  for (const char c : name) in_patterns.append(c == '{' || c == '}' ? 2 : 1, c);
  the_program() = {std::move(name), std::move(in_patterns), std::move(commands)};
}

std::string program_name() { return the_program().name; }

std::string with_program_name(std::string_view pattern) {
  std::string out;
  for (std::size_t from = 0; from < pattern.size();) {
    const std::size_t at = pattern.find(kOwnName, from);
    out += pattern.substr(from, at - from);  // to the end where there is none
    if (at == std::string_view::npos) break;
    out += is_command(pattern, at) ? the_program().in_patterns : std::string(kOwnName);
    from = at + kOwnName.size();
  }
  return out;
}

}  // namespace mjarm
