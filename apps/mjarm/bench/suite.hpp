#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/mjarm/bench/report.hpp"
#include "apps/mjarm/command.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::app {

/// What all suites against peers can be told.
struct BenchOptions {
  std::string robot, data, peers, rounds = "5", out;
  bool json = false, no_timing = false;
};

/// Adds the options to a suite's command.
/// @param data_help  what `--data` holds.
void add_bench_options(CLI::App& app, BenchOptions& options, Msg data_help);

/// Measures one robot, given by name or file, in so many rounds.
using BenchRobot = std::function<Result<BenchResult>(const std::string& robot, int rounds)>;

/// Measures every robot that was asked for, or `robots` where none was, and writes the table or the
/// JSON document.
/// @return an error where an answer of mjarm is wrong, or what `measure` fails with.
[[nodiscard]] Result<int> run_suite(const BenchOptions& options,
                                    const std::vector<std::string>& robots,
                                    const std::vector<Msg>& columns, const BenchRobot& measure);

}  // namespace mjarm::app
