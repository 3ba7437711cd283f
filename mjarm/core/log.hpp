#pragma once

#include <string_view>

namespace mjarm {

/// How much is said on standard error.
enum class LogLevel {
  debug,    ///< every detail
  info,     ///< what a user wants to know; the default
  warning,  ///< only what may be wrong
  error,    ///< only what went wrong
};

/// Says less or more from now on.
void set_log_level(LogLevel level) noexcept;
/// The level in use.
[[nodiscard]] LogLevel log_level() noexcept;

/// Writes one line to standard error; line breaks inside `line` become spaces. The text comes from
/// the catalogue (`text(Msg::...)`). Warnings begin with a word that says so; errors stand as they
/// are, because theirs begin with `file:line:`. May be called from any thread; never throws.
void log_debug(std::string_view line) noexcept;
void log_info(std::string_view line) noexcept;
void log_warning(std::string_view line) noexcept;
void log_error(std::string_view line) noexcept;

/// Shows `line` as the changing last line of a terminal, in place of the one before; empty takes it
/// away. Lines of the log go above it. Only for a standard error that is a terminal.
void show_status(std::string_view line) noexcept;

}  // namespace mjarm
