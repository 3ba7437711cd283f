#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "mjarm/core/result.hpp"

/// Everything mjarm asks of the operating system, in one place.
namespace mjarm {

/// Absolute path of the running program.
[[nodiscard]] Result<std::filesystem::path> executable_path();

/// File of the shared library (or program) that holds the function at `address`; empty where
/// unknown.
[[nodiscard]] std::filesystem::path library_of(const void* address);

/// Value of an environment variable; none where it is not set.
[[nodiscard]] std::optional<std::string> environment(const std::string& name);

/// Name of the locale of messages: the first of LC_ALL, LC_MESSAGES, LANG that is not empty; empty
/// where none is.
[[nodiscard]] std::string locale_name();

/// True where standard error is a terminal that understands cursor control.
[[nodiscard]] bool stderr_is_terminal() noexcept;

/// Columns of the terminal on standard error; 80 where unknown.
[[nodiscard]] int terminal_width() noexcept;

/// True where a graphical display is announced (X11 or Wayland); it may still refuse to open.
[[nodiscard]] bool has_display();

/// Folder of this user for files of a kind, by the XDG rules: what the environment variable names
/// (an absolute path), else `below_home`, such as ".cache", in the home; none where there is none.
[[nodiscard]] std::optional<std::filesystem::path> user_folder(const std::string& variable,
                                                               const std::string& below_home);

/// Folder for temporary files (TMPDIR, else the system's).
[[nodiscard]] std::filesystem::path temp_directory();

/// Number of this process.
[[nodiscard]] long process_id() noexcept;

/// Whether a process of that number runs.
[[nodiscard]] bool is_running(long process) noexcept;

/// Cores this process may use, at least 1.
[[nodiscard]] int core_count() noexcept;

/// From now on the first Ctrl-C (or SIGTERM) only sets `interrupted()`; the second ends the
/// process.
void catch_interrupts() noexcept;
/// True once Ctrl-C was pressed after `catch_interrupts()`.
[[nodiscard]] bool interrupted() noexcept;

/// What the operating system says about error number `code` (errno), in English.
[[nodiscard]] std::string system_message(int code);

/// Opens a shared library by name (e.g. "libEGL.so.1"), seen only by who holds the handle; it stays
/// open until the process ends.
/// @return not_available with what the system says.
[[nodiscard]] Result<void*> open_library(const std::string& name);
/// Lets every part of the process find the symbols of a library that is already open.
void publish_library(const std::string& name) noexcept;
/// Address of a symbol in a library that is open, or null.
[[nodiscard]] void* library_symbol(void* library, const std::string& symbol) noexcept;

}  // namespace mjarm
