#include <gtest/gtest.h>

#include "mjarm/collision/edge_check.hpp"
#include "mjarm/collision/fast_check.hpp"
#include "mjarm/collision/random_scene_test.hpp"

namespace mjarm {
namespace {

/// With margins free is what keeps them, to the padding: obstacles and paired links apart.
TEST(SphereMargins, FreeIsWhatKeepsThem) {
  Rng rng(71);
  int kept = 0, lost = 0;
  for (int round = 0; round < 60; ++round) {
    const Arm arm = testing::random_arm(2 + round % 6, rng);
    SphereSet set = testing::random_spheres(arm, rng);
    const bool by_links = round % 2 == 0;
    if (!by_links) set.pairs.clear();
    const Obstacles world = by_links ? Obstacles{} : testing::random_world(rng, 3);
    const double margin = rng.uniform(0.002, 0.08);
    // The margin that is not looked at must not matter.
    const SphereMargins margins{by_links ? 0.03 : margin, by_links ? margin : 0.0};
    const FastChecker bare =
        FastChecker::create(FastRobot::create(arm, set).value(), world).value();
    const FastChecker wide =
        FastChecker::create(FastRobot::create(arm, set, margins).value(), world).value();
    if (bare.fixed_overlap()) continue;
    const double padding = 2 * wide.robot().padding() + 2e-4;  // a cylinder's rounding as well
    for (int i = 0; i < 40; ++i) {
      std::vector<double> q;
      for (int k = 0; k < arm.dof(); ++k) {
        q.push_back(rng.uniform(arm.limits.lower[k], arm.limits.upper[k]));
      }
      const double clearance = bare.clearance(q).distance;
      if (std::abs(clearance - margin) < padding) continue;
      ASSERT_EQ(wide.is_free(q), clearance > margin) << clearance << " of " << margin;
      ++(clearance > margin ? kept : lost);
    }
  }
  EXPECT_GT(kept, 300);
  EXPECT_GT(lost, 100);
}

TEST(SphereMargins, EdgesAreProvedToKeepThem) {
  Rng rng(72);
  int proved = 0;
  for (int round = 0; round < 80; ++round) {
    const Arm arm = testing::random_arm(3 + round % 4, rng);
    const SphereSet set = testing::random_spheres(arm, rng);
    const Obstacles world = testing::random_world(rng, 2);
    const FastChecker bare =
        FastChecker::create(FastRobot::create(arm, set).value(), world).value();
    const FastChecker wide =
        FastChecker::create(FastRobot::create(arm, set, {0.02, 0.02}).value(), world).value();
    JointVec from(arm.dof()), to(arm.dof());
    for (int k = 0; k < arm.dof(); ++k) {
      from[k] = rng.uniform(arm.limits.lower[k], arm.limits.upper[k]);
      to[k] =
          std::clamp(from[k] + rng.uniform(-0.6, 0.6), arm.limits.lower[k], arm.limits.upper[k]);
    }
    if (check_edge(wide, as_span(from), as_span(to)).verdict != EdgeVerdict::free) continue;
    ++proved;
    for (int i = 0; i <= 200; ++i) {
      const JointVec q = from + (to - from) * (i / 200.0);
      EXPECT_GT(bare.clearance(as_span(q)).distance, 0.02 - 1e-4);
    }
  }
  EXPECT_GT(proved, 10);
}

TEST(SphereMargins, OutOfRangeIsRefused) {
  Rng rng(73);
  const Arm arm = testing::panda();
  const SphereSet set = testing::random_spheres(arm, rng);
  for (const SphereMargins& margins : {SphereMargins{-1e-9, 0}, {0, 11}, {0, std::nan("")}}) {
    const auto robot = FastRobot::create(arm, set, margins);
    ASSERT_FALSE(robot);
    EXPECT_EQ(robot.error().code, Errc::bad_input);
  }
}

}  // namespace
}  // namespace mjarm
