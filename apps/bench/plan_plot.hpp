#pragma once

#include <filesystem>
#include <vector>

#include "apps/bench/plan_report.hpp"

namespace mjarm::app {

/// Draws `bench_plan.svg` and `bench_plan.png`: which share of the problems of a set has a valid
/// path within what time, one panel a table of `sets`; and the times of a plan and of a state check
/// over the number of obstacles. Nothing where there is nothing to draw.
/// @param crowds  of `crowded`, one run and one pair of checks each.
[[nodiscard]] Result<void> draw_plan_times(const std::vector<PlanTable>& sets,
                                           const std::vector<CrowdedSet>& crowds,
                                           const PlanTable& crowded,
                                           const std::filesystem::path& folder);

}  // namespace mjarm::app
