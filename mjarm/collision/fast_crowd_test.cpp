#include <gtest/gtest.h>

#include <cmath>

#include "mjarm/collision/edge_check.hpp"
#include "mjarm/collision/fast_oracle_test.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"

namespace mjarm {
namespace {

using testing::compare;
using testing::kLevels;
using testing::Tally;

/// Many solids away from the base, and some clouds.
Obstacles crowded_world(Rng& rng, int solids, int clouds, int points) {
  Obstacles out = testing::random_world(rng, solids, rng.uniform() < 0.3);
  for (Obstacle& solid : out.solids) solid.X_WO.p += 0.8 * solid.X_WO.p.normalized();
  for (int i = 0; i < clouds; ++i) {
    out.clouds.push_back(testing::random_cloud(rng, points, rng.uniform(1e-4, 0.02)));
  }
  return out;
}

/// Random robots in the worlds that `make(rng, round)` makes, on every level of SIMD.
template <class Make>
void compare_in_worlds(std::uint64_t seed, int states, const Make& make,
                       const testing::Slack& slack = {}) {
  Rng rng(seed);
  Tally tally;
  const int worlds = testing::rounds(12, 3000, 10);
  for (int round = 0; round < worlds; ++round) {
    const Arm arm = testing::random_arm(1 + round % 9, rng);
    SphereSet set = testing::random_spheres(arm, rng);
    set.pairs.resize(std::min<std::size_t>(set.pairs.size(), 1));
    const Obstacles world = make(rng, round);
    for (const SimdLevel level : kLevels) {
      compare(arm, set, world, level, rng, states, tally, slack);
    }
    if (::testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(tally.free, worlds * 10);
  EXPECT_GT(tally.blocked, worlds * 10);
}

TEST(FastCrowd, NeverFreeWhereRandomRobotsCollide) {
  compare_in_worlds(51, 50, [](Rng& rng, int round) {
    const int solids = round % 3 == 0 ? 0 : static_cast<int>(rng.below(300));
    const int points = round % 3 == 1 ? 0 : 1 + static_cast<int>(rng.below(400));
    return crowded_world(rng, solids, static_cast<int>(rng.below(3)), points);
  });
}

Obstacles composite_world(Rng& rng, int count) {
  Obstacles out;
  for (int i = 0; i < count; ++i) out.solids.push_back(testing::random_composite(rng));
  return out;
}

TEST(FastCrowd, NeverFreeInMeshesPolytopesAndHeightFields) {
  compare_in_worlds(
      55, 40,
      [](Rng& rng, int) { return composite_world(rng, 1 + static_cast<int>(rng.below(4))); },
      {.thick = 3e-3});
}

/// Also for spheres that are small against the mesh, which is then a little thicker.
TEST(FastCrowd, NothingIsFreeInsideOfASolidMesh) {
  Rng rng(56);
  const Arm arm = testing::panda();
  int inside = 0;
  for (int round = 0; round < 10; ++round) {
    SphereSet set;
    set.links = {{"tip", 6, {{testing::random_vector(rng, 0.1), 1e-5}}}};
    Obstacles world;
    world.solids = {{"mesh", {}, testing::random_closed_mesh(rng, round % 2 == 0 ? 1 : 3)}};
    world.solids[0].X_WO.p = testing::random_vector(rng, 0.5);
    const auto robot = FastRobot::create(arm, set).value();
    const auto checker = FastChecker::create(robot, world, kLevels[round % 3]).value();
    const double thick = round % 2 == 0 ? 0.03 : 0.09;
    for (int k = 0; k < 500; ++k) {
      const JointVec q = testing::random_q(arm, rng);
      const double truth = testing::true_clearance(arm, set, world, as_span(q));
      if (truth <= 0) {
        ++inside;
        ASSERT_FALSE(checker.is_free(as_span(q)));
        ASSERT_LT(checker.clearance(as_span(q)).distance, 1e-4);
      } else if (truth > thick) {
        ASSERT_TRUE(checker.is_free(as_span(q)));
      }
    }
  }
  EXPECT_GT(inside, 150);
}

TEST(FastCrowd, NoFalseCertificateOfEdges) {
  Rng rng(52);
  int free = 0, hit = 0;
  const int worlds = testing::rounds(15, 1500, 10);
  for (int round = 0; round < worlds; ++round) {
    const Arm arm = testing::random_arm(2 + round % 6, rng);
    SphereSet set = testing::random_spheres(arm, rng);
    for (LinkSpheres& link : set.links) {
      for (Sphere& sphere : link.spheres) sphere.radius *= 0.3;
    }
    const Obstacles world = round % 3 == 0   ? crowded_world(rng, 70, 0, 0)
                            : round % 3 == 1 ? crowded_world(rng, 0, 1, 60)
                                             : composite_world(rng, 1);
    const auto robot = FastRobot::create(arm, set).value();
    const auto checker = FastChecker::create(robot, world, kLevels[round % 3]).value();
    if (checker.fixed_overlap()) continue;
    for (int k = 0; k < 20; ++k) {
      const JointVec q0 = testing::random_q(arm, rng);
      const JointVec q1 = q0 + rng.uniform(0.02, 0.5) * (testing::random_q(arm, rng) - q0);
      const EdgeResult result = check_edge(checker, as_span(q0), as_span(q1));
      const auto clearance = [&](double t) {
        const JointVec q = q0 + t * (q1 - q0);
        return testing::true_clearance(arm, set, world, as_span(q));
      };
      if (result.verdict == EdgeVerdict::hit) {
        ++hit;
        ASSERT_LT(clearance(result.t), 2 * robot.padding() + 4e-6);
      }
      if (result.verdict != EdgeVerdict::free) continue;
      ++free;
      for (int i = 0; i <= 40; ++i) ASSERT_GT(clearance(i / 40.0), 0) << "false certificate";
    }
  }
  EXPECT_GT(free, worlds * 3);
  EXPECT_GT(hit, worlds / 3);
}

TEST(FastCrowd, NearestObstacleIsNamed) {
  Rng rng(53);
  const Arm arm = testing::panda();
  SphereSet set = testing::random_spheres(arm, rng);
  set.pairs.clear();
  const auto robot = FastRobot::create(arm, set).value();
  for (int round = 0; round < 12; ++round) {
    const Obstacles world = crowded_world(rng, round % 3 == 0 ? 3 : 100, 2, 200);
    const auto checker = FastChecker::create(robot, world, kLevels[round % 3]).value();
    for (int i = 0; i < testing::rounds(40, 40, 3); ++i) {
      const JointVec q = testing::random_q(arm, rng);
      const SphereClearance found = checker.clearance(as_span(q));
      const double truth = testing::true_clearance(arm, set, world, as_span(q), true);
      if (truth < 0 || truth > 0.9) continue;
      EXPECT_NEAR(found.distance, truth, 1e-4);
      const auto index = static_cast<std::size_t>(found.obstacle);
      Obstacles one;
      if (index < world.solids.size()) {
        one.solids = {world.solids[index]};
      } else {
        one.clouds = {world.clouds.at(index - world.solids.size())};
      }
      EXPECT_NEAR(testing::true_clearance(arm, set, one, as_span(q), true), truth, 1e-4);
    }
  }
}

/// Clouds that leave a sorted tree nothing to work with take no longer, and stay right.
TEST(FastCrowd, PointsInOnePlaceOrFarAway) {
  Rng rng(54);
  const Arm arm = testing::panda();
  const SphereSet set = testing::random_spheres(arm, rng);
  const auto robot = FastRobot::create(arm, set).value();
  const Eigen::Vector3d far(9e3, -9e3, 9e3);
  for (int kind = 0; kind < 4; ++kind) {
    Obstacles world;
    world.clouds = {{"heap", std::vector<Eigen::Vector3d>(kMaxPoints, {0.5, 0.2, 0.4}), 0.05}};
    std::vector<Eigen::Vector3d>& points = world.clouds[0].points_W;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (kind == 1) points[i].x() += 1e-6 * static_cast<double>(i);
      if (kind == 2 && i % 2 == 0) points[i] = far;
    }
    if (kind == 3) points.clear();
    const auto checker = FastChecker::create(robot, world).value();
    Obstacles few = world;
    if (kind == 0 || kind == 2) few.clouds[0].points_W = {{0.5, 0.2, 0.4}, far};
    for (int i = 0; i < (kind == 1 ? 5 : 200); ++i) {
      const JointVec q = testing::random_q(arm, rng);
      const double truth = testing::true_clearance(arm, set, few, as_span(q));
      if (std::abs(truth) < 4e-4) continue;
      EXPECT_EQ(checker.is_free(as_span(q)), truth > 0) << kind;
    }
  }
}

TEST(FastCrowd, PieceAtRestInACloud) {
  const Arm arm = testing::panda();
  SphereSet set;
  set.links = {{"base", -1, {{{0, 0, 0.05}, 0.08}}}, {"hand", 6, {{{0, 0, 0.1}, 0.02}}}};
  Obstacles world;
  world.solids = {{"far", {{5, 5, 5}, Eigen::Matrix3d::Identity()}, BallShape{0.1}}};
  world.clouds = {{"away", {{3, 3, 3}}, 0.1}, {"floor", {{3, 3, 3}, {0, 0.1, 0}}, 0.05}};
  const auto checker = FastChecker::create(FastRobot::create(arm, set).value(), world).value();
  ASSERT_TRUE(checker.fixed_overlap().has_value());
  EXPECT_EQ(checker.fixed_overlap()->obstacle, 2);
  EXPECT_EQ(obstacle_name(world, checker.fixed_overlap()->obstacle), "floor");
}

}  // namespace
}  // namespace mjarm
