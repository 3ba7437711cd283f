#pragma once

#include <vector>

#include "apps/mjarm/demos/demos.hpp"
#include "mjarm/core/pose.hpp"

/// Figures of the tutorial that several demos share.
namespace mjarm::app {

/// Start of the IK demos [rad]; the tool stands at (-0.136, 0.297, 0.097).
[[nodiscard]] std::vector<double> tutorial_seed();

/// The same, or what the user gives in its place with --seed-q.
[[nodiscard]] Result<std::vector<double>> tutorial_seed(const DemoValues& values, const Arm& arm);

/// Goal of the IK demos: (-0.13, 0.6, 0.1), euler (3.14, 0, 1.57).
[[nodiscard]] Pose tutorial_goal();

/// Orientation "tool down", euler (3.14, 0, 0).
[[nodiscard]] Eigen::Matrix3d tool_down();

}  // namespace mjarm::app
