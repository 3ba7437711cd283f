#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "apps/bench/rl_run.hpp"

namespace mjarm::app {

/// Lets the peers in a Python environment learn one set with one seed, on goals drawn by ours and
/// judged on the same unseen ones. Each first has to show that its environment does what ours does.
/// @return one run a peer, see run_peers().
[[nodiscard]] Result<std::vector<LearningRun>> run_learning_peers(
    const Model& model, const LearningSet& set, std::uint64_t seed,
    const std::filesystem::path& environment);

}  // namespace mjarm::app
