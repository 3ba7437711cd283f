#include "apps/mjarm/demos/tutorial.hpp"

#include "apps/mjarm/demos/demo_stage.hpp"
#include "mjarm/core/rotation.hpp"

namespace mjarm::app {

std::vector<double> tutorial_seed() { return {-1.57, -1.34, 2.65, -1.3, 1.55, 0}; }

int tutorial_dof(const DemoValues& values) {
  return values.seed_q.empty() && !values.to ? static_cast<int>(tutorial_seed().size()) : 0;
}

Result<std::vector<double>> tutorial_seed(const DemoValues& values, const Arm& arm) {
  if (!values.seed_q.empty()) return read_posture("--seed-q", values.seed_q, arm);
  std::vector<double> seed = tutorial_seed();
  if (static_cast<int>(seed.size()) != arm.dof()) seed.assign(arm.home.begin(), arm.home.end());
  return seed;
}

Pose tutorial_goal() { return {{-0.13, 0.6, 0.1}, from_euler({3.14, 0, 1.57})}; }

Eigen::Matrix3d tool_down() { return from_euler({3.14, 0, 0}); }

}  // namespace mjarm::app
