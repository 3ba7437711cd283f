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

CLI::App& add_subcommand(CLI::App& parent, const std::string& name, Msg summary, Msg examples) {
  CLI::App& app = *parent.add_subcommand(name, text(summary));
  app.footer(text(examples));
  app.allow_extras();  // what is not known is reported by us, with the nearest right word
  app.fallthrough();   // global options may stand anywhere
  app.require_subcommand(0, 1);
  return app;
}

}  // namespace mjarm::app
