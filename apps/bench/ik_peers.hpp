#pragma once

#include <filesystem>
#include <vector>

#include "apps/bench/ik_run.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::app {

/// Runs the peers of a Python environment on the same cases, each in a process and a loop of its
/// own (`bench/peers/ik.py`).
/// @param environment  folder of a virtual environment with some of the peers in it.
/// @return their runs, not judged yet; a peer that fails has a run that says why. An error where
/// the
///         environment has no Python, the robot does not come from a URDF, or the user stopped it.
[[nodiscard]] Result<std::vector<IkRun>> run_ik_peers(const IkProblem& problem,
                                                      const std::filesystem::path& environment,
                                                      int rounds);

}  // namespace mjarm::app
