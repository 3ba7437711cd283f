#include "apps/mjarm/demos/tutorial.hpp"

#include "mjarm/core/rotation.hpp"

namespace mjarm::app {

std::vector<double> tutorial_seed() { return {-1.57, -1.34, 2.65, -1.3, 1.55, 0}; }

Pose tutorial_goal() { return {{-0.13, 0.6, 0.1}, from_euler({3.14, 0, 1.57})}; }

Eigen::Matrix3d tool_down() { return from_euler({3.14, 0, 0}); }

}  // namespace mjarm::app
