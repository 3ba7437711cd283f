#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

namespace mjarm {

/// The languages of the catalogue.
enum class Language { english, chinese };

/// One text a user can see, in all languages, its values left open as `{}` (fmt syntax, e.g.
/// `{:.3f}`). All of them stand in the catalogue `messages/`, one list a room, as constants
/// `msg::ROOM_WHAT`; the header of a list is included only where its texts are used, so that a new
/// text rebuilds one room.
struct Msg {
  const char* english;
  const char* chinese;
  /// The text in `language`, its values left open.
  [[nodiscard]] constexpr std::string_view in(Language language) const {
    return language == Language::chinese ? chinese : english;
  }
};

/// Sets the language of all messages from now on; called once, at the start of a program.
void set_language(Language language) noexcept;
/// The language in use.
[[nodiscard]] Language language() noexcept;
/// Language of a name ("en", "zh", "zh-CN", "zh_CN.UTF-8", ...): Chinese for names that begin with
/// "zh", else English.
[[nodiscard]] Language language_of(std::string_view name) noexcept;
/// Language of the process's locale (LC_ALL, LC_MESSAGES, LANG, in this order).
[[nodiscard]] Language language_of_locale();

/// A value put into a message.
using MsgArg = std::variant<std::string, double, long long, unsigned long long>;

/// The text in the language in use, its `{}` filled in order. A text that does not fit its values
/// comes back with its braces; never throws for that.
[[nodiscard]] std::string format_message(Msg message, std::initializer_list<MsgArg> args);

namespace detail {
inline MsgArg message_arg(std::string_view value) { return std::string(value); }
inline MsgArg message_arg(const char* value) { return std::string(value); }
inline MsgArg message_arg(double value) { return value; }
template <class Int>
  requires std::is_integral_v<Int>
MsgArg message_arg(Int value) {
  if constexpr (std::is_unsigned_v<Int>) {
    return static_cast<unsigned long long>(value);
  } else {
    return static_cast<long long>(value);
  }
}
}  // namespace detail

/// Shorthand: `text(msg::model_no_file, path)`.
template <class... Args>
[[nodiscard]] std::string text(Msg message, const Args&... args) {
  return format_message(message, {detail::message_arg(args)...});
}

}  // namespace mjarm
