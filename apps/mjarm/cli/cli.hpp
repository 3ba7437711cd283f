#pragma once

#include <span>
#include <string>
#include <vector>

#include "apps/mjarm/cli/command.hpp"

namespace mjarm::app {

/// Runs the command line `arguments` (without the name of the program) of a program `mjarm` with
/// these subcommands.
/// @return the exit code: 0 done, 1 well-formed but cannot be done, 2 bad input or usage.
[[nodiscard]] int run(std::span<const Command> commands, const std::vector<std::string>& arguments);

}  // namespace mjarm::app
