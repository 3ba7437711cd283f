#include <string>
#include <utility>
#include <vector>

#include "apps/bench/suite.hpp"
#include "apps/mjarm/cli/cli.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/sim.hpp"
#include "mjarm/core/os_streams.hpp"
#include "mjarm/core/program_name.hpp"
#include "mjarm/core/user_cache.hpp"

namespace mjarm::app {
namespace {

/// `bench` with all suites as subcommands of its own.
Run setup(CLI::App& bench) {
  std::vector<std::pair<const CLI::App*, Run>> suites;
  for (const Command& suite :
       {ik_suite(), path_suite(), plan_suite(), time_suite(), control_suite(), pick_suite(),
        sim_suite(), rl_suite(), python_suite()}) {
    CLI::App& app = add_subcommand(bench, suite.name, suite.summary, suite.examples);
    suites.emplace_back(&app, suite.setup(app));
  }
  return [suites]() -> Result<int> {
    std::string names;
    for (const auto& [app, run] : suites) {
      if (is_called(*app)) return run();
      names += (names.empty() ? "" : text(msg::core_comma)) + name_of(*app);
    }
    return fail(Errc::usage, text(msg::app_no_subcommand, program_name() + " bench", names));
  };
}

}  // namespace
}  // namespace mjarm::app

/// `mjarm-bench ik ...` and `mjarm bench ik ...`, which hands its own arguments over, are the same.
int main(int argc, char** argv) {
  using namespace mjarm;
  open_standard_streams();
  UserCache::leave_alone();  // a first plan is to be one
  std::vector<std::string> arguments = program_arguments(argc, argv);
  const std::size_t word = app::command_word(arguments);
  if (word == arguments.size() || arguments[word] != "bench") {
    arguments.insert(arguments.begin(), "bench");
  }
  const app::Command commands[] = {
      {"bench", msg::sim_bench_all_summary, msg::sim_bench_all_examples, app::setup}};
  return app::run(commands, arguments);
}
