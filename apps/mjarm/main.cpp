#include "apps/mjarm/cli/cli.hpp"
#include "apps/mjarm/commands/commands.hpp"
#include "mjarm/core/os_streams.hpp"

int main(int argc, char** argv) {
  mjarm::open_standard_streams();
  return mjarm::app::run(mjarm::app::commands(), {argv + (argc > 0), argv + argc});
}
