#pragma once

#include <string>
#include <vector>

#include "apps/mjarm/bench/ik_run.hpp"

namespace mjarm::app {

/// A robot and what all contestants did on it.
struct IkResult {
  std::string robot;
  std::string file;  ///< name of the robot's file, without its folder
  std::vector<IkRun> runs;
};

/// When and on what was measured: "AMD EPYC 9R14, avx512; 2026-11-21".
[[nodiscard]] std::string bench_occasion();

/// One table a robot in Markdown, aligned, so that it also reads well on a terminal.
/// @param timing  false leaves out everything that differs from run to run.
[[nodiscard]] std::string ik_table(const std::vector<IkResult>& results, bool timing);

/// The same and every miss, as one JSON document.
[[nodiscard]] std::string ik_json(const std::vector<IkResult>& results, bool timing);

}  // namespace mjarm::app
