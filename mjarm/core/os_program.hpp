#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"

namespace mjarm {

/// Runs another program with these arguments and waits for its end. It shares the standard streams
/// of this one; Ctrl-C ends both.
/// @param program  path, or a name that is looked for in PATH.
/// @return its exit code, 128 + N where signal N ended it; an error where it cannot be started or
///         the user stopped it.
[[nodiscard]] Result<int> run_program(const std::filesystem::path& program,
                                      const std::vector<std::string>& arguments);

/// Goes on as another program with these arguments, in the place of this one.
/// @param program  path.
/// @return only where it cannot be started: why.
[[nodiscard]] Error become_program(const std::filesystem::path& program,
                                   const std::vector<std::string>& arguments);

}  // namespace mjarm
