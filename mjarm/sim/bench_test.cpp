#include "mjarm/sim/bench.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mjarm/sim/worlds_test.hpp"

namespace mjarm {
namespace {

TEST(BenchSim, ComparesEveryModeThatWorksWithBareSteps) {
  const testing::Loaded robot = testing::load_shipped("ur5e");
  const auto entries = bench_sim(robot.model, robot.arm, {.rounds = 1, .steps = 50});
  ASSERT_TRUE(entries) << entries.error().what;
  std::vector<std::string> names;
  for (const SimBenchEntry& entry : *entries) {
    names.push_back(entry.name);
    EXPECT_GT(entry.us, 0);
    EXPECT_NEAR(entry.rtf, 1e6 * robot.model.timestep() / entry.us, 1e-6 * entry.rtf);
    EXPECT_NEAR(entry.ratio, (*entries)[0].us / entry.us, 1e-9);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"mj_step", "servo", "servo_gravity", "computed_torque",
                                             "recorded"}));
}

TEST(BenchSim, NeedsActuators) {
  testing::Loaded robot = testing::load_shipped("ur5e");
  for (ArmJoint& joint : robot.arm.joints) joint.actuator.reset();
  EXPECT_FALSE(bench_sim(robot.model, robot.arm, {.rounds = 1, .steps = 5}));
}

}  // namespace
}  // namespace mjarm
