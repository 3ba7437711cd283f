#include <gtest/gtest.h>

#include "mjarm/collision/edge_check.hpp"
#include "mjarm/collision/fast_access_internal.hpp"
#include "mjarm/collision/fast_oracle_test.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"

/// Wrists of many spheres, whose self-collisions are looked up in tables.
namespace mjarm {
namespace {

/// Two links of a joint and three that the joint after the next one, or the last but one, moves.
SphereSet random_wrist(const Arm& arm, Rng& rng) {
  const int last = arm.dof() - 1;
  const int near = last - 1 - static_cast<int>(rng.below(2));
  SphereSet out;
  const auto add = [&](int joint, int count, double size) {
    LinkSpheres link{"link " + std::to_string(out.links.size()), joint, {}};
    for (int i = 0; i < count; ++i) {
      link.spheres.push_back({testing::random_vector(rng, size), rng.uniform(0.01, 0.05)});
    }
    out.links.push_back(link);
  };
  add(near, 9, 0.2);
  add(near, 8, 0.1);
  add(last, 12, 0.15);
  add(last, 8, 0.2);
  add(last, 1, 0.1);
  out.pairs = {{0, 2}, {3, 0}, {1, 3}, {4, 1}};
  return out;
}

TEST(FastApart, NeverFreeWhereWristsCollide) {
  Rng rng(31);
  testing::Tally tally;
  int tables = 0;
  for (int i = 0; i < testing::rounds(40, 2000); ++i) {
    const Arm arm = i % 2 == 0 ? testing::panda() : testing::ur5e();
    const SphereSet set = random_wrist(arm, rng);
    tables += static_cast<int>(detail::FastAccess::data(*FastRobot::create(arm, set)).apart.size());
    testing::compare(arm, set, {}, testing::kLevels[static_cast<std::size_t>(i) % 3], rng, 300,
                     tally);
  }
  EXPECT_GT(tables, 20);
  EXPECT_GT(tally.free, 100);
  EXPECT_GT(tally.blocked, 100);
}

TEST(FastApart, ProvedEdgesOfWristsAreFree) {
  Rng rng(32);
  int proved = 0;
  const int wrists = testing::rounds(200, 5000, 20);
  for (int i = 0; i < wrists; ++i) {
    const Arm arm = i % 2 == 0 ? testing::panda() : testing::ur5e();
    const SphereSet set = random_wrist(arm, rng);
    const auto checker = FastChecker::create(FastRobot::create(arm, set).value(), {}).value();
    for (int k = 0; k < 60; ++k) {
      const JointVec a = testing::random_q(arm, rng);
      const JointVec b = a + rng.uniform(0.05, 0.5) * (testing::random_q(arm, rng) - a);
      if (check_edge(checker, as_span(a), as_span(b)).verdict != EdgeVerdict::free) continue;
      ++proved;
      for (int j = 0; j <= 50; ++j) {
        const JointVec q = a + j / 50.0 * (b - a);
        ASSERT_GT(testing::true_clearance(arm, set, {}, as_span(q)), 0);
      }
    }
  }
  EXPECT_GT(proved, wrists / 4);
}

}  // namespace
}  // namespace mjarm
