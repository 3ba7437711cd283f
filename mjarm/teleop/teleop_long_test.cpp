#include <gtest/gtest.h>

#include <iostream>

#include "mjarm/teleop/random_drive_test.hpp"
#include "tests/support/rounds.hpp"

namespace mjarm {
namespace {

class TeleopLong : public ::testing::TestWithParam<const char*> {};

TEST_P(TeleopLong, TenMinutesOfAnythingTouchNothing) {
  if (!testing::is_long()) GTEST_SKIP() << testing::kLongOnly;
  const Robot robot = load_robot(GetParam()).value();
  for (const std::uint64_t seed : {1, 2, 3}) {
    const testing::DriveResult result = testing::drive(robot, {}, seed, 600);
    EXPECT_EQ(result.contact, "") << "seed " << seed << ", " << result.time << " s";
    EXPECT_GT(result.way, 10) << "seed " << seed;
    EXPECT_GT(result.held, 5) << "seed " << seed;
    std::cout << GetParam() << ", seed " << seed << ": " << result.way << " m, " << result.held
              << " s something was held\n";
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, TeleopLong,
                         ::testing::Values("franka_emika_panda/pick.xml",
                                           "universal_robots_ur5e/pick.xml",
                                           "franka_emika_panda/clutter.xml",
                                           "universal_robots_ur5e/clutter.xml"));

}  // namespace
}  // namespace mjarm
