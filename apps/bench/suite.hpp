#pragma once

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "apps/mjarm/cli/command.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/output_folder.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm::app {

// The suites, each a subcommand of `mjarm bench`.
[[nodiscard]] Command ik_suite();
[[nodiscard]] Command path_suite();
[[nodiscard]] Command plan_suite();
[[nodiscard]] Command time_suite();
[[nodiscard]] Command control_suite();
[[nodiscard]] Command pick_suite();
[[nodiscard]] Command sim_suite();
[[nodiscard]] Command rl_suite();
[[nodiscard]] Command python_suite();

/// What one contestant did on one set of cases, ready to be shown.
struct BenchEntry {
  std::string who;           ///< "mjarm", "mjarm numeric", "ruckig", ...
  std::string version = {};  ///< of a peer; empty for ours
  std::string set = {};      ///< which cases
  std::string timed = {};    ///< "c++" or "python": where the clock stands
  std::string error = {};    ///< why there is nothing else; empty where all went well

  std::vector<std::string> cells = {};  ///< of the suite's own columns
  JsonDoc details = {};                 ///< members of the JSON document
  std::vector<double> us = {};          ///< [us] of each call
  double ratio = 0;  ///< how many times as long as ours; 0: as the medians of both tell
};

/// A robot and what all contestants did on it.
struct BenchResult {
  std::string robot;
  std::string file;  ///< name of the robot's file, without its folder; empty where there is none
  std::vector<BenchEntry> entries = {};
  std::string wrong = {};  ///< what is wrong with the answers of mjarm; empty where all is right
};

/// The value that `percent` (< 100) of all are below; 0 where there are none.
[[nodiscard]] double percentile(std::vector<double> values, std::size_t percent);

/// A number with three digits or so.
[[nodiscard]] std::string rounded(double value);

/// How many of all, `3/7`, and of how many cases where those were only the first ones of `cases`.
[[nodiscard]] std::string count_of(int count, std::size_t asked, std::size_t cases);

/// When and on what was measured: "AMD EPYC 9R14, avx512; 2026-11-21".
[[nodiscard]] std::string bench_occasion();

/// How all suites can be told to answer.
struct ReportOptions {
  bool json = false;
  bool no_timing = false;  ///< leave out everything that differs from run to run
};
void add_report_options(CLI::App& app, ReportOptions& options);

/// Writes the answer about one robot to standard output: its name over the tables, or the JSON
/// document.
void print_robot(const ReportOptions& options, const Robot& robot, const std::string& tables,
                 const JsonDoc& doc);

/// Writes everything into the folder: `bench.json`, and what `write_more()` does; and the answer,
/// the table or the JSON document, to standard output.
/// @param columns  headings of `BenchEntry::cells`.
/// @param told     says where everything is.
/// @return an error where an answer of mjarm is wrong.
[[nodiscard]] Result<int> report_in_folder(const ReportOptions& options,
                                           const std::vector<BenchResult>& results,
                                           const std::vector<Msg>& columns,
                                           const OutputFolder& folder,
                                           const std::function<Result<void>()>& write_more,
                                           Msg told);

/// What suites that measure robots beside peers can be told.
struct BenchOptions : ReportOptions {
  std::string robot, tip, data, peers, rounds = "5", out;
  std::string seed = "1";  ///< of the cases that a suite with variants makes up
  Replace replace;
};
/// Measures one robot, given by name or file, in so many rounds.
using BenchRobot = Result<BenchResult> (*)(const BenchOptions& options, const std::string& robot,
                                           int rounds);
/// What a suite measures instead where its flag is given, of the UR5e where no robot is named.
struct BenchVariant {
  const char* flag;  ///< "--all"
  Msg help;
  std::vector<Msg> columns;
  BenchRobot measure;
};
/// Adds the options to such a suite's command.
/// @param data_help  what `--data` holds.
/// @param tool       whether it asks for the pose of a tool.
/// @return measures each robot, writes the table or the JSON document; fails where an answer of
/// mjarm is wrong, or with what `measure` fails.
[[nodiscard]] Run setup_robots(CLI::App& app, Msg data_help, bool tool, std::vector<Msg> columns,
                               BenchRobot measure, std::vector<BenchVariant> variants = {});

/// True where peers are to run on this robot; says so.
[[nodiscard]] bool wants_peers(const std::string& peers, const std::string& robot);
/// What work that was stopped fails with.
[[nodiscard]] Error stopped();

/// The set of that name; null where there is none.
template <class Set>
const Set* set_named(const std::vector<Set>& sets, const std::string& name) {
  const auto found = std::ranges::find(sets, name, &Set::name);
  return found == sets.end() ? nullptr : &*found;
}

/// An entry of mjarm itself: each case of `count` has a time that any call beats.
[[nodiscard]] BenchEntry our_entry(std::string who, std::string set, std::size_t count);

/// Does every case, `call(i)`, `rounds` times over, all of them in a round; stops at Ctrl-C.
template <class Call>
void in_rounds(int rounds, std::size_t count, Progress& progress, const Call& call) {
  for (int round = 0; round < rounds && !interrupted(); ++round) {
    for (std::size_t i = 0; i < count; ++i) call(i);
    progress.advance();
  }
}

/// Judges all runs, ours and those of the peers.
/// @param result  names the robot.
/// @param judge   fills cells and details of a run; gives how many of its answers are wrong.
/// @param wrong   says how many of mjarm are.
template <class Run, class Judge>
Result<BenchResult> judged(BenchResult result, std::vector<Run> runs, const Judge& judge,
                           Msg wrong) {
  int count = 0;
  for (Run& run : runs) {
    const Result<int> bad = judge(run);
    if (!bad) return fail(bad.error());
    count += run.version.empty() ? *bad : 0;
    result.entries.push_back(std::move(run));
  }
  if (count > 0) result.wrong = text(wrong, result.robot, count);
  return result;
}

/// Adds the runs of the peers by `run_peers()`, where they are wanted, to ours, and judges all.
/// @param result, judge, wrong  as `judged()` has them.
template <class Run, class RunPeers, class Judge>
Result<BenchResult> compare(const std::string& peers, BenchResult result, std::vector<Run> runs,
                            const RunPeers& run_peers, const Judge& judge, Msg wrong) {
  if (interrupted()) return fail(stopped());
  if (wants_peers(peers, result.robot)) {
    Result<std::vector<Run>> theirs = run_peers();
    if (!theirs) return fail(std::move(theirs.error()));
    std::ranges::move(*theirs, std::back_inserter(runs));
  }
  return judged(std::move(result), std::move(runs), judge, wrong);
}

}  // namespace mjarm::app
