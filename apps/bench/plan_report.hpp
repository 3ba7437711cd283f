#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/bench/plan_run.hpp"

namespace mjarm::app {

/// Headings of `BenchEntry::cells`.
[[nodiscard]] std::vector<Msg> plan_columns(bool timing);

/// All that is shown of one set in one table.
struct PlanTable {
  const PlanSet* set = nullptr;
  std::vector<PlanRun> runs = {};  ///< ours of a case (`BenchEntry::set`) before those of peers
  bool sum = false;                ///< adds what each contestant did on all cases together
  /// State checks, one a case, in order; of one only: shown where `sum` is.
  std::vector<CheckTimes> checks = {};
};

/// The entries of a table. A peer that fails in the same way on every case is one entry.
[[nodiscard]] std::vector<BenchEntry> plan_entries(const PlanTable& table, bool timing);

/// Paths that are not what was asked for.
[[nodiscard]] int wrong_paths(const PlanRun& run);

/// Writes `paths_NAME_WHO.json`, one a contestant, with every path and its time, so that others can
/// judge them: `{"id":{"path":[[q],...],"us":t},...}`.
[[nodiscard]] Result<void> write_paths(const PlanTable& table, bool timing,
                                       const std::filesystem::path& folder);

}  // namespace mjarm::app
