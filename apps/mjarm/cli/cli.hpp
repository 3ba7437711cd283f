#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "apps/mjarm/cli/command.hpp"

namespace mjarm::app {

/// The index of the word that names the command: the first that is neither a global option nor the
/// value of one; the number of arguments where there is none.
[[nodiscard]] std::size_t command_word(const std::vector<std::string>& arguments) noexcept;

/// Runs the command line `arguments` (without the name of the program) of a program `mjarm` with
/// these subcommands. Never throws.
/// @return the exit code: 0 done, 1 well-formed but cannot be done, 2 bad input or usage.
[[nodiscard]] int run(std::span<const Command> commands,
                      const std::vector<std::string>& arguments) noexcept;

}  // namespace mjarm::app
