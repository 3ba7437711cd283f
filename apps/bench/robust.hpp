#pragma once

#include <string>
#include <vector>

#include "apps/bench/robust_lap.hpp"
#include "apps/bench/suite.hpp"
#include "mjarm/render/plot.hpp"

namespace mjarm::app {

/// One way of control in wrong worlds.
struct RobustRun {
  std::string name;
  ControlMode mode = ControlMode::computed_torque;
  ControlOptions control = {};
  std::vector<RobustWorld> worlds = {};
  double timestep = 0;  ///< [s] of control
};

/// Laps of an ellipse by computed torque as it is, with an integral, and by `robust`, each in the
/// same `worlds` (drawn from `seed`).
/// @return an error where the ellipse is out of reach, or a simulation broke down.
[[nodiscard]] Result<std::vector<RobustRun>> drive_wrong_worlds(const Robot& robot, int worlds,
                                                                int seed);

[[nodiscard]] std::string robust_table(const std::vector<RobustRun>& runs);
[[nodiscard]] std::vector<JsonDoc> robust_docs(const std::vector<RobustRun>& runs);
/// Distance from the ellipse over time, of the world in which each was farthest from it.
[[nodiscard]] render::Plot robust_plot(const std::vector<RobustRun>& runs);

}  // namespace mjarm::app
