#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "apps/bench/plan_peers.hpp"
#include "apps/bench/plan_report.hpp"
#include "apps/bench/suite.hpp"

namespace mjarm::app {

/// Solves all problems of a set, scene by scene, ours and then the peers', so that a busy machine
/// is so for all of them; and times state checks.
/// @param peers    no environment: ours alone.
/// @param advance  told after every scene; false stops the work.
[[nodiscard]] Result<PlanTable> run_plan_set(const PlanSet& set, std::uint64_t seed,
                                             const PlanPeers& peers, const Advance& advance);

/// Solves all problems of a set with no time to spare, and with 2 and 10 ms for each.
[[nodiscard]] Result<PlanTable> run_anytime(const PlanSet& set, std::uint64_t seed,
                                            const Advance& advance);

/// Solves the problems amid each crowd, and times state checks there.
[[nodiscard]] Result<PlanTable> run_crowds(const std::vector<CrowdedSet>& crowds,
                                           std::uint64_t seed, const Advance& advance);

}  // namespace mjarm::app
