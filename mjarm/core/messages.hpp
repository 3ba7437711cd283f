#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

namespace mjarm {

/// Every text a user can see has one entry here, in English and in Chinese. The entries stand in
/// `messages/ROOM.inc`, one list a room.
enum class Msg {
#define MJARM_MSG(id, english, chinese) id,
#include "mjarm/core/messages/all.inc"
#undef MJARM_MSG
  count_  ///< number of entries, not a message
};

/// The languages of the catalogue.
enum class Language { english, chinese };

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
using MsgArg = std::variant<std::string, double, long long>;

/// The text of `id` in the language in use, its `{}` filled in order (fmt syntax, e.g. `{:.3f}`).
/// An entry that does not fit its values comes back with its braces; never throws for that.
[[nodiscard]] std::string format_message(Msg id, std::initializer_list<MsgArg> args);

namespace detail {
inline MsgArg message_arg(std::string_view value) { return std::string(value); }
inline MsgArg message_arg(const char* value) { return std::string(value); }
inline MsgArg message_arg(double value) { return value; }
template <class Int>
  requires std::is_integral_v<Int>
MsgArg message_arg(Int value) {
  return static_cast<long long>(value);
}
}  // namespace detail

/// The text of `id` in `language` as it stands in the catalogue, placeholders unfilled.
[[nodiscard]] std::string_view message_template(Msg id, Language language) noexcept;

/// Shorthand: `text(Msg::model_no_file, path)`.
template <class... Args>
[[nodiscard]] std::string text(Msg id, const Args&... args) {
  return format_message(id, {detail::message_arg(args)...});
}

}  // namespace mjarm
