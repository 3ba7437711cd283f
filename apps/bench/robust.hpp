#pragma once

#include <string>

#include "apps/bench/suite.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm::app {

/// What `mjarm bench control --robust` can be told.
struct RobustWords {
  std::string worlds = "20", clearance_worlds = "200", seed = "1", plot;
};
void add_robust_options(CLI::App& app, RobustWords& words);

/// Laps of an ellipse by computed torque as it is, with an integral, and by `robust`, each in the
/// same wrong worlds, and a planned way beside a wall by `robust`; writes the tables or the JSON
/// document, and a plot of the world in which each was farthest from the ellipse.
/// @return an error where the ellipse is out of reach, or a simulation broke down.
[[nodiscard]] Result<int> run_robust(const ReportOptions& report, const RobustWords& words,
                                     const Robot& robot);

}  // namespace mjarm::app
