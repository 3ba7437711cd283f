#include "apps/mjarm/cli/cli.hpp"
#include "apps/mjarm/commands/commands.hpp"

int main(int argc, char** argv) {
  return mjarm::app::run(mjarm::app::commands(), {argv + (argc > 0), argv + argc});
}
