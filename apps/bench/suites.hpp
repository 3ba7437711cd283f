#pragma once

#include "apps/mjarm/cli/command.hpp"

namespace mjarm::app {

/// A suite of `mjarm bench`, added to `bench` as a subcommand of its own.
struct BenchSuite {
  const CLI::App* app;
  Run run;
};
/// `bench` with all suites.
[[nodiscard]] Command bench_command();

[[nodiscard]] BenchSuite add_bench_ik(CLI::App& bench);
[[nodiscard]] BenchSuite add_bench_control(CLI::App& bench);
[[nodiscard]] BenchSuite add_bench_rl(CLI::App& bench);
[[nodiscard]] BenchSuite add_bench_sim(CLI::App& bench);
[[nodiscard]] BenchSuite add_bench_path(CLI::App& bench);
[[nodiscard]] BenchSuite add_bench_plan(CLI::App& bench);
[[nodiscard]] BenchSuite add_bench_time(CLI::App& bench);

}  // namespace mjarm::app
