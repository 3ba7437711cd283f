#pragma once

#include <string>

#include "apps/bench/suite.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm::app {

/// What `mjarm bench control --bumps` can be told.
struct BumpWords {
  std::string count = "200", quiet_runs = "30";
};
void add_bump_options(CLI::App& app, BumpWords& words);

/// Bumps in wrong worlds until so many of them can be told by joints, and quiet runs of motion
/// without any (drive_bump()); writes the tables or the JSON document, and a plot of the bump that
/// took longest to be noticed. A quiet run is two minutes of motion, so that 30 are an hour.
[[nodiscard]] Result<int> run_bumps(const ReportOptions& report, const BumpWords& words,
                                    const std::string& seed, const std::string& plot,
                                    const Robot& robot);

}  // namespace mjarm::app
