#include <memory>
#include <string>
#include <vector>

#include "apps/bench/suites.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/messages/sim.hpp"

namespace mjarm::app {
namespace {

Run setup(CLI::App& app) {
  auto suites = std::make_shared<std::vector<BenchSuite>>();
  suites->push_back(add_bench_ik(app));
  suites->push_back(add_bench_path(app));
  suites->push_back(add_bench_plan(app));
  suites->push_back(add_bench_time(app));
  suites->push_back(add_bench_control(app));
  suites->push_back(add_bench_sim(app));
  suites->push_back(add_bench_rl(app));
  return [suites]() -> Result<int> {
    std::string names;
    for (const BenchSuite& suite : *suites) {
      if (is_called(*suite.app)) return suite.run();
      names += (names.empty() ? "" : ", ") + name_of(*suite.app);
    }
    return fail(Errc::usage, text(msg::app_no_subcommand, "mjarm bench", names));
  };
}

}  // namespace

Command bench_command() {
  return {"bench", msg::sim_bench_all_summary, msg::sim_bench_all_examples, setup};
}

}  // namespace mjarm::app
