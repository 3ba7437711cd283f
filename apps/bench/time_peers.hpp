#pragma once

#include <filesystem>
#include <vector>

#include "apps/bench/time_run.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::app {

/// Runs the peers of a Python environment on the same motions (`bench/peers/timing.py`).
/// @return their runs, judged; a peer that fails has a run that says why. Fails as `run_peers`.
[[nodiscard]] Result<std::vector<TimeRun>> run_time_peers(const std::vector<TimeSet>& sets,
                                                          const std::filesystem::path& environment,
                                                          int rounds);

}  // namespace mjarm::app
