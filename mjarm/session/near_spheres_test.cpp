#include "mjarm/session/near_spheres.hpp"

#include <gtest/gtest.h>

#include "mjarm/collision/random_scene_test.hpp"

namespace mjarm::session {
namespace {

struct Found {
  std::vector<PlacedSphere> placed;
  std::optional<ClosestPair> pair;
};

Found find_pair(const FastRobot& robot, const Obstacles& world, const JointVec& q,
                const SphereClearance* only = nullptr) {
  Found out;
  out.placed = place_spheres(robot, as_span(q));
  out.pair =
      closest_pair(world, out.placed, obstacle_neighbours(robot.spheres(), world, out.placed, only),
                   link_neighbours(robot.spheres(), out.placed));
  return out;
}

TEST(NearSpheres, TheClosestPairIsTheOraclesWithPointsOnBoth) {
  Rng rng(61);
  int apart = 0, overlapping = 0, links = 0;
  for (int round = 0; round < 150; ++round) {
    const Arm arm = testing::random_arm(1 + round % 7, rng);
    const FastRobot robot = FastRobot::create(arm, testing::random_spheres(arm, rng)).value();
    Obstacles world = testing::random_world(rng, 4, round % 2 == 0);
    world.clouds = {testing::random_cloud(rng, 20, 0.01)};
    const JointVec q = testing::random_q(arm, rng);
    const Found found = find_pair(robot, world, q);
    ASSERT_TRUE(found.pair);
    const double truth = testing::true_clearance(arm, robot.spheres(), world, as_span(q), true);
    if (truth < 1e-4) {  // how deep, is told from the surface of the solid at most
      ++overlapping;
      EXPECT_LT(found.pair->to.distance, 1e-4);
      continue;
    }
    ASSERT_NEAR(found.pair->to.distance, truth, 1e-9) << "round " << round;
    ++apart;
    const ClosestPair& pair = *found.pair;
    const PlacedSphere& sphere = found.placed[static_cast<std::size_t>(pair.sphere)];
    EXPECT_NEAR((pair.p2_W - pair.p1_W).norm(), truth, 1e-6);
    EXPECT_NEAR((pair.p1_W - sphere.p_W).norm(), sphere.radius, 1e-9);
    if (pair.to.obstacle < 0) {
      ++links;
      const PlacedSphere& other = found.placed[static_cast<std::size_t>(pair.to.sphere)];
      EXPECT_NEAR((pair.p2_W - other.p_W).norm(), other.radius, 1e-9);
    } else if (pair.to.obstacle < 4) {
      EXPECT_LT(distance(world.solids[static_cast<std::size_t>(pair.to.obstacle)], pair.p2_W),
                1e-6);
    } else {
      EXPECT_LT(distance(world.clouds[0], pair.p2_W), 1e-6);
    }
  }
  EXPECT_GT(apart, 30);
  EXPECT_GT(overlapping, 10);
  EXPECT_GT(links, 3);
}

TEST(NearSpheres, OnlyThePairOfTheFastChecker) {
  Rng rng(62);
  int looked = 0;
  for (int round = 0; round < 60; ++round) {
    const Arm arm = testing::random_arm(4, rng);
    const FastRobot robot = FastRobot::create(arm, testing::random_spheres(arm, rng)).value();
    const Obstacles world = testing::random_world(rng, 4);
    const JointVec q = testing::random_q(arm, rng);
    const SphereClearance nearest = FastChecker::create(robot, world).value().clearance(as_span(q));
    if (nearest.link < 0 || nearest.distance < 0) continue;
    ++looked;
    const Found found = find_pair(robot, world, q, &nearest);
    ASSERT_TRUE(found.pair);
    EXPECT_EQ(found.pair->to.obstacle < 0, nearest.obstacle < 0);
    EXPECT_NEAR(found.pair->to.distance, find_pair(robot, world, q).pair->to.distance,
                4 * robot.padding());
  }
  EXPECT_GT(looked, 10);
}

TEST(NearSpheres, IgnoredPairsAndWhatIsAtRestHaveNoNeighbour) {
  const Arm arm = testing::make_arm("turner", {{{0, 0, 0}, {0, 0, 0}, {0, 0, 1}, -3, 3}}, {});
  const SphereSet set{{{"foot", -1, {{{0, 0, -0.2}, 0.1}}}, {"hand", 0, {{{0.5, 0, 0}, 0.1}}}}, {}};
  const FastRobot robot = FastRobot::create(arm, set).value();
  Obstacles world{{{"wall", {{0.7, 0, 0}, Eigen::Matrix3d::Identity()}, BoxShape{{0.05, 1, 1}}}}};
  const JointVec q = JointVec::Zero(1);
  const Found found = find_pair(robot, world, q);
  ASSERT_TRUE(found.pair);
  EXPECT_EQ(found.pair->sphere, 1);
  EXPECT_NEAR(found.pair->to.distance, 0.05, 1e-12);
  EXPECT_LT((found.pair->p2_W - Eigen::Vector3d(0.65, 0, 0)).norm(), 1e-9);
  world.ignored = {{1, 0}};
  EXPECT_FALSE(find_pair(robot, world, q).pair);
}

TEST(NearSpheres, InsideOfASolidThereIsNoWayBetween) {
  const Arm arm = testing::make_arm("turner", {{{0, 0, 0}, {0, 0, 0}, {0, 0, 1}, -3, 3}}, {});
  const FastRobot robot = FastRobot::create(arm, {{{"hand", 0, {{{0.5, 0, 0}, 0.1}}}}, {}}).value();
  const Obstacles world{
      {{"block", {{0.5, 0, 0}, Eigen::Matrix3d::Identity()}, BoxShape{{1, 1, 1}}}}};
  const Found found = find_pair(robot, world, JointVec::Zero(1));
  ASSERT_TRUE(found.pair);
  EXPECT_NEAR(found.pair->to.distance, -0.1, 1e-12);
  EXPECT_EQ(found.pair->p1_W, found.pair->p2_W);
  EXPECT_TRUE(found.pair->p1_W.allFinite());
}

}  // namespace
}  // namespace mjarm::session
