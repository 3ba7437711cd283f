#pragma once

#include <span>

#include "apps/mjarm/cli/command.hpp"

namespace mjarm::app {

/// All subcommands of `mjarm`, in the order of the help.
[[nodiscard]] std::span<const Command> commands();

}  // namespace mjarm::app
