#include "mjarm/core/messages.hpp"

#include <fmt/args.h>
#include <fmt/format.h>

#include <atomic>
#include <optional>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/program_name.hpp"

namespace mjarm {
namespace {

std::atomic<Language> current_language{Language::english};
thread_local std::optional<Language> language_of_thread;

}  // namespace

void set_language(Language language) noexcept { current_language = language; }

Language language() noexcept { return language_of_thread.value_or(current_language); }

LanguageScope::LanguageScope(Language language) noexcept : before_(language_of_thread) {
  language_of_thread = language;
}
LanguageScope::~LanguageScope() { language_of_thread = before_; }

Language language_of(std::string_view name) noexcept {
  const bool chinese =
      name.size() >= 2 && (name[0] == 'z' || name[0] == 'Z') && (name[1] == 'h' || name[1] == 'H');
  return chinese ? Language::chinese : Language::english;
}

Language language_of_locale() { return language_of(locale_name()); }

std::string format_message(Msg message, std::initializer_list<MsgArg> args) {
  const std::string pattern = with_program_name(message.in(language()));
  fmt::dynamic_format_arg_store<fmt::format_context> store;
  for (const MsgArg& arg : args) {
    std::visit([&store](const auto& value) { store.push_back(value); }, arg);
  }
  try {
    return fmt::vformat(pattern, store);
  } catch (const fmt::format_error&) {
    return pattern;  // a message with its braces is better than none
  }
}

}  // namespace mjarm
