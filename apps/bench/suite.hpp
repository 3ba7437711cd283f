#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/bench/report.hpp"
#include "apps/mjarm/cli/command.hpp"
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

/// The same of suites that ask for the pose of a tool.
struct ToolBenchOptions : BenchOptions {
  std::string tip;
};
void add_tool_bench_options(CLI::App& app, ToolBenchOptions& options, Msg data_help);

/// Told after every round; false stops the work.
using Advance = std::function<bool()>;

/// Shows a bar of so many rounds, and stops them at Ctrl-C.
[[nodiscard]] Advance show_rounds(const std::string& label, std::uint64_t rounds);
/// What work that was stopped fails with.
[[nodiscard]] Error stopped();

/// Runs mjarm on every set by `run_set(set, advance)`, which gives nothing where it was stopped.
template <class Run, class Set, class RunSet>
Result<std::vector<Run>> run_sets(const std::string& label, const std::vector<Set>& sets,
                                  int rounds, const RunSet& run_set) {
  const Advance advance = show_rounds(label, sets.size() * static_cast<std::uint64_t>(rounds));
  std::vector<Run> runs;
  for (const Set& set : sets) {
    std::optional<Run> run = run_set(set, advance);
    if (!run) return fail(stopped());
    runs.push_back(std::move(*run));
  }
  return runs;
}

/// True where peers are to run on this robot; says so.
[[nodiscard]] bool wants_peers(const BenchOptions& options, const std::string& robot);

/// Adds the runs of the peers by `run_peers()`, where they are wanted, to ours.
template <class Run, class RunPeers>
Result<void> add_peers(const BenchOptions& options, const std::string& robot,
                       std::vector<Run>& runs, const RunPeers& run_peers) {
  if (!wants_peers(options, robot)) return {};
  Result<std::vector<Run>> peers = run_peers();
  if (!peers) return fail(std::move(peers.error()));
  for (Run& run : *peers) runs.push_back(std::move(run));
  return {};
}

/// Measures one robot, given by name or file, in so many rounds.
using BenchRobot = std::function<Result<BenchResult>(const std::string& robot, int rounds)>;

/// Measures every robot that was asked for, or `robots` where none was, and writes the table or the
/// JSON document.
/// @return an error where an answer of mjarm is wrong, or what `measure` fails with.
[[nodiscard]] Result<int> run_suite(const BenchOptions& options,
                                    const std::vector<std::string>& robots,
                                    const std::vector<Msg>& columns, const BenchRobot& measure);

}  // namespace mjarm::app
