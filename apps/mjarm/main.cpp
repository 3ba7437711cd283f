#include "apps/mjarm/cli/cli.hpp"
#include "apps/mjarm/commands/commands.hpp"
#include "mjarm/core/os_streams.hpp"
#include "mjarm/model/model_trial.hpp"

int main(int argc, char** argv) {
  mjarm::open_standard_streams();
  const std::vector<std::string> arguments = mjarm::program_arguments(argc, argv);
  if (const std::optional<int> trial = mjarm::model_trial(arguments)) return *trial;
  return mjarm::app::run(mjarm::app::commands(), arguments);
}
