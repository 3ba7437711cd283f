#include "apps/mjarm/command.hpp"

namespace mjarm::app {

std::span<const Command> commands() {
  static const Command list[] = {
#define MJARM_COMMAND(name) name##_command(),
#include "apps/mjarm/commands.inc"
#undef MJARM_COMMAND
  };
  return list;
}

}  // namespace mjarm::app
