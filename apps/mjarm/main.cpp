#include <exception>
#include <string>
#include <vector>

#include "apps/mjarm/cli/cli.hpp"
#include "apps/mjarm/commands/commands.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/log.hpp"

int main(int argc, char** argv) {
  try {
    return mjarm::app::run(mjarm::app::commands(), {argv + (argc > 0), argv + argc});
  } catch (const std::exception& error) {
    // Nothing of ours throws; what comes here is memory that ran out, or a fault of ours.
    mjarm::log_error(mjarm::text(mjarm::msg::app_internal_error, error.what()));
    return 1;
  }
}
