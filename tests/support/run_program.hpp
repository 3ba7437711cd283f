#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace mjarm::support {

/// How to run a program. Every default is usable as is.
struct RunOptions {
  std::filesystem::path folder = {};  ///< working directory; empty = that of the test
  std::string input = {};             ///< what the program reads from standard input
  /// Set in its environment; locale variables are cleared first, so that messages are English.
  std::vector<std::pair<std::string, std::string>> environment = {};
};

/// What a program did.
struct ProgramResult {
  int exit_code = -1;           ///< as the program gave it; -N where signal N ended it
  std::string out;              ///< standard output
  std::string err;              ///< standard error
  double cpu_seconds = 0;       ///< [s] computing time, its own children included
  std::size_t peak_memory = 0;  ///< [bytes] resident, of it or of the largest of its children
};

#if defined(_WIN32)
inline constexpr bool kStartsPrograms = false;  // not written so far
#else
inline constexpr bool kStartsPrograms = true;
#endif

/// Runs a program with its arguments and waits for its end.
/// @throws std::runtime_error where it cannot be started.
[[nodiscard]] ProgramResult run_program(const std::filesystem::path& program,
                                        const std::vector<std::string>& arguments,
                                        const RunOptions& options = {});

/// The lines of a text, without their ends.
[[nodiscard]] std::vector<std::string> lines_of(std::string_view text);

}  // namespace mjarm::support
