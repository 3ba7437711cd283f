#pragma once

#include <functional>
#include <string>

#include "apps/mjarm/cli/options.hpp"
#include "mjarm/core/messages.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::app {

/// What a subcommand does after its options were read. Returns the exit code (0 done, 1 cannot be
/// done), or an error, which is printed as one line and gives the exit code of its kind.
using Run = std::function<Result<int>()>;

/// One subcommand. Its file has one function `Command NAME_command()`; the list `commands.inc` has
/// one line for it. Options are read as text and parsed by the command, so that messages come from
/// the catalogue.
struct Command {
  const char* name;
  Msg summary;   ///< one line for the list of commands
  Msg examples;  ///< shown below the options in its help
  /// Adds the options; the Run owns what they are bound to. Null: `program` does all of it.
  Run (*setup)(CLI::App& app);
  /// Name of the program beside this one that takes the whole command line; null: this one.
  const char* program = nullptr;
};

}  // namespace mjarm::app
