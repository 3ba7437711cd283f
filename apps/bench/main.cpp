#include <algorithm>
#include <exception>
#include <string>
#include <vector>

#include "apps/bench/suites.hpp"
#include "apps/mjarm/cli/cli.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/log.hpp"

/// `mjarm-bench ik ...` and `mjarm bench ik ...`, which hands its own arguments over, are the same.
int main(int argc, char** argv) {
  try {
    std::vector<std::string> arguments(argv + (argc > 0), argv + argc);
    if (std::ranges::find(arguments, "bench") == arguments.end()) {
      arguments.insert(arguments.begin(), "bench");
    }
    const mjarm::app::Command commands[] = {mjarm::app::bench_command()};
    return mjarm::app::run(commands, arguments);
  } catch (const std::exception& error) {
    mjarm::log_error(mjarm::text(mjarm::msg::app_internal_error, error.what()));
    return 1;
  }
}
