#include <gtest/gtest.h>

#include "mjarm/collision/edge_check.hpp"
#include "mjarm/collision/random_scene_test.hpp"

/// Links and obstacles that are not held against each other.
namespace mjarm {
namespace {

/// The oracle without ignored pairs: each link held against the obstacles that are left to it.
double clearance_link_by_link(const Arm& arm, const SphereSet& set, const Obstacles& world,
                              std::span<const double> q) {
  SphereSet alone = set;
  double least = testing::true_clearance(arm, set, {}, q, true);
  alone.pairs.clear();
  for (std::size_t l = 0; l < set.links.size(); ++l) {
    if (set.links[l].joint < 0) continue;
    alone.links = {set.links[l]};
    Obstacles left;
    for (std::size_t i = 0; i < world.solids.size(); ++i) {
      const IgnoredPair pair{static_cast<int>(l), static_cast<int>(i)};
      if (std::find(world.ignored.begin(), world.ignored.end(), pair) == world.ignored.end()) {
        left.solids.push_back(world.solids[i]);
      }
    }
    least = std::min(least, testing::true_clearance(arm, alone, left, q, true));
  }
  return least;
}

TEST(IgnoredPairs, AreLeftOutOfEveryCheck) {
  Rng rng(331);
  int free_count = 0, hit = 0, edges = 0;
  for (int round = 0; round < 40; ++round) {
    const Arm arm = testing::random_arm(6, rng);
    const SphereSet set = testing::random_spheres(arm, rng);
    Obstacles world = testing::random_world(rng, round % 4 == 0 ? 100 : 6);
    for (std::size_t l = 0; l < set.links.size(); ++l) {
      for (std::size_t i = 0; i < world.solids.size(); ++i) {
        if (set.links[l].joint < 0 || rng.uniform() < 0.6) {
          world.ignored.push_back({static_cast<int>(l), static_cast<int>(i)});
        }
      }
    }
    const FastRobot robot = FastRobot::create(arm, set).value();
    const FastChecker checker = FastChecker::create(robot, world).value();
    EXPECT_FALSE(checker.fixed_overlap().has_value());
    const double padding = 2 * robot.padding();
    for (int k = 0; k < 100; ++k) {
      const JointVec q = testing::random_q(arm, rng);
      const double clearance = clearance_link_by_link(arm, set, world, as_span(q));
      const bool free = checker.is_free(as_span(q));
      if (clearance < 0) {
        EXPECT_FALSE(free);
      }
      if (clearance > padding) {
        EXPECT_TRUE(free);
      }
      (free ? free_count : hit) += 1;
      const SphereClearance found = checker.clearance(as_span(q));
      EXPECT_LE(found.distance, std::max(clearance, 0.0) + 1e-6);
      EXPECT_GE(found.distance, std::min(clearance, 0.99) - padding - 1e-5);
      const IgnoredPair pair{found.link, found.obstacle};
      EXPECT_EQ(std::count(world.ignored.begin(), world.ignored.end(), pair), 0);
      const JointVec goal = q + JointVec::Constant(arm.dof(), 0.01);
      if (clearance > 0.2 &&
          check_edge(checker, as_span(q), as_span(goal)).verdict == EdgeVerdict::free) {
        ++edges;
      }
    }
  }
  EXPECT_GT(free_count, 100);
  EXPECT_GT(hit, 100);
  EXPECT_GT(edges, 10);
}

}  // namespace
}  // namespace mjarm
