#pragma once

#include <numbers>
#include <vector>

#include "mjarm/core/rotation.hpp"

namespace mjarm::testing {

/// The tool points down.
inline const Eigen::Matrix3d kDown = from_euler({std::numbers::pi, 0, 0});
/// A posture of the UR5e in front of its base, with the tool down.
inline const std::vector<double> kSeed{-1.57, -1.34, 2.65, -1.3, 1.55, 0};

}  // namespace mjarm::testing
