#pragma once

#include <string>
#include <vector>

#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/messages.hpp"

namespace mjarm::app {

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
  std::vector<BenchEntry> entries;
  std::string wrong = {};  ///< what is wrong with the answers of mjarm; empty where all is right
};

/// Median and 99th percentile of times; 0 where there are none.
struct Times {
  double median = 0;
  double p99 = 0;
};
[[nodiscard]] Times times_of(std::vector<double> us);

/// A number with three digits or so.
[[nodiscard]] std::string rounded(double value);

/// When and on what was measured: "AMD EPYC 9R14, avx512; 2026-11-21".
[[nodiscard]] std::string bench_occasion();

/// One table a robot in Markdown, aligned, so that it also reads well on a terminal: the entries of
/// a set together, ours first, then from fast to slow.
/// @param columns  headings of `BenchEntry::cells`.
/// @param timing   false leaves out everything that differs from run to run.
[[nodiscard]] std::string bench_table(const std::vector<BenchResult>& results,
                                      const std::vector<Msg>& columns, bool timing);

/// The same with all details, as one JSON document.
[[nodiscard]] std::string bench_json(const std::vector<BenchResult>& results, bool timing);

}  // namespace mjarm::app
