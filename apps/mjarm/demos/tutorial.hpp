#pragma once

#include <vector>

#include "apps/mjarm/demos/demos.hpp"
#include "mjarm/core/pose.hpp"

/// Figures of the tutorial that several demos share.
namespace mjarm::app {

/// Start of the IK demos [rad]; the tool stands at (-0.136, 0.297, 0.097).
[[nodiscard]] std::vector<double> tutorial_seed();

/// Number of joints that the tutorial's start is for; 0 = any, where the user gives a start or a
/// goal of his own.
[[nodiscard]] int tutorial_dof(const DemoValues& values);

/// What the user gives in its place with --seed-q; home of an arm with another number of joints.
[[nodiscard]] Result<std::vector<double>> tutorial_seed(const DemoValues& values, const Arm& arm);

/// Goal of the IK demos: (-0.13, 0.6, 0.1), euler (3.14, 0, 1.57).
[[nodiscard]] Pose tutorial_goal();

/// Orientation "tool down", euler (3.14, 0, 0).
[[nodiscard]] Eigen::Matrix3d tool_down();

}  // namespace mjarm::app
