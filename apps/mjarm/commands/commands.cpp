#include "apps/mjarm/commands/commands.hpp"

#include "mjarm/core/messages/sim.hpp"

namespace mjarm::app {

#define MJARM_COMMAND(name) Command name##_command();
#include "apps/mjarm/commands/commands.inc"
#undef MJARM_COMMAND

std::span<const Command> commands() {
  static const Command list[] = {
#define MJARM_COMMAND(name) name##_command(),
#include "apps/mjarm/commands/commands.inc"
#undef MJARM_COMMAND
      {"bench", msg::sim_bench_all_summary, msg::sim_bench_all_examples, nullptr, "mjarm-bench"},
  };
  return list;
}

}  // namespace mjarm::app
