#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "apps/bench/plan_run.hpp"

namespace mjarm::app {

/// How peers are run.
struct PlanPeers {
  std::filesystem::path environment;  ///< of Python
  int every = 10;                     ///< slow ones solve one problem in so many
  double limit = 10;                  ///< [s] for one problem, and again to shorten its path
};

/// Runs the peers on these problems of a set that comes from a file, and judges their paths. A peer
/// that has a clock of its own inside has two runs.
/// @return one run a peer and clock, see run_peers().
[[nodiscard]] Result<std::vector<PlanRun>> run_plan_peers(const PlanSet& set,
                                                          std::span<const std::size_t> problems,
                                                          const PlanPeers& peers);

}  // namespace mjarm::app
