#include "mjarm/collision/link_balls.hpp"

#include <gtest/gtest.h>

#include "mjarm/collision/convex_internal.hpp"
#include "mjarm/collision/cover.hpp"
#include "mjarm/collision/cover_robots_test.hpp"
#include "mjarm/collision/random_scene_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"

namespace mjarm {
namespace {

using Eigen::Vector3d;

/// Distances of the pieces of each obstacle, with an oracle that does the same in another way.
TEST(BallScene, DistancesArePointsOfTheObstacles) {
  Rng rng(81);
  const Arm arm = testing::random_arm(3, rng);
  const int rounds = testing::rounds(8, 80, 1);
  int compared = 0;
  for (int round = 0; round < rounds; ++round) {
    Obstacles world = testing::random_world(rng, 3);
    for (int k = 0; k < 3; ++k) world.solids.push_back(testing::random_composite(rng));
    const SphereSet set = testing::random_spheres(arm, rng);
    const FastChecker checker =
        FastChecker::create(FastRobot::create(arm, set).value(), world).value();
    const BallScene scene = ball_scene(checker, world);
    for (int k = 0; k < 8; ++k) {
      const Vector3d p = testing::random_vector(rng, 1);
      std::vector<double> least(world.solids.size(), std::numeric_limits<double>::infinity());
      for (const StandingPiece& piece : scene.pieces) {
        const Vector3d outside = (piece.low - p).cwiseMax(p - piece.high).cwiseMax(0.0);
        const double distance = piece.distance(p, 10);
        EXPECT_LE(outside.norm(), distance + 1e-9);
        double& of_obstacle = least[static_cast<std::size_t>(piece.obstacle)];
        of_obstacle = std::min(of_obstacle, distance);
      }
      for (std::size_t i = 0; i < least.size(); ++i) {
        const Obstacle& solid = world.solids[i];
        const double exact =
            std::max(testing::exact_point_distance(solid.shape, solid.X_WO.inverse() * p), 0.0);
        constexpr double kOracle = 1e-5;  // of polytopes, where it is a limit
        EXPECT_GE(least[i], exact - kOracle);
        const auto* mesh = std::get_if<MeshShape>(&solid.shape);
        const bool is_surface = mesh != nullptr && mesh->solid && exact == 0;
        if (std::isinf(least[i]) || is_surface) continue;
        EXPECT_NEAR(least[i], exact, kOracle);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 30 * rounds);
}

TEST(BallScene, BallsAreInTheSolidsOfLinks) {
  const testing::CoveredRobot robot = testing::covered_robot("universal_robots_ur5e/wall.xml");
  const ModelCover cover = cover_model(robot.model, robot.arm).value();
  const FastChecker checker =
      FastChecker::create(FastRobot::create(robot.arm, cover.spheres).value(), cover.scene)
          .value()
          .looking_closer(cover.solids);
  const BallScene scene = ball_scene(checker, cover.scene);
  EXPECT_EQ(scene.ignored.size(), cover.scene.ignored.size());
  ASSERT_GE(scene.balls.size(), 6u);
  EXPECT_EQ(scene.balls.front().joint, robot.arm.dof() - 1);
  // Where a link is free, so is its ball.
  Rng rng(82);
  int near = 0;
  for (int k = 0; k < 400; ++k) {
    const JointVec q = testing::random_q(robot.arm, rng);
    if (!checker.is_free(as_span(q))) continue;
    std::array<Pose, kMaxDof> X_WJ;
    fk_all(robot.arm, as_span(q), X_WJ);
    for (const LinkBall& ball : scene.balls) {
      const Vector3d p = X_WJ[static_cast<std::size_t>(ball.joint)] * ball.center;
      for (const StandingPiece& piece : scene.pieces) {
        if (std::ranges::count(scene.ignored, IgnoredPair{ball.link, piece.obstacle}) > 0) continue;
        const double distance = piece.distance(p, 1);
        EXPECT_GE(distance, ball.radius);
        near += distance < ball.radius + 0.1 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(near, 20);
}

TEST(Convex, InscribedBallsAreInsideAndLarge) {
  Rng rng(83);
  for (int round = 0; round < 50; ++round) {
    detail::CoverSolid solid;
    solid.X_LS = {testing::random_vector(rng, 1), from_euler(testing::random_vector(rng, 3))};
    solid.kind = static_cast<detail::SolidKind>(rng.below(5));
    solid.size = {rng.uniform(0.05, 0.2), rng.uniform(0.05, 0.2), rng.uniform(0.05, 0.2)};
    const Sphere ball = detail::Convex(solid).inscribed_ball();
    EXPECT_NEAR(solid.signed_distance(ball.center), -ball.radius, 1e-9);
    for (int k = 0; k < 100; ++k) {  // no place is deeper
      const Vector3d p = solid.X_LS * testing::random_vector(rng, 0.2);
      EXPECT_LE(-solid.signed_distance(p), ball.radius + 1e-9);
    }
  }
}

/// Of a box as a hull the largest ball is known.
TEST(Convex, InscribedBallOfAHullIsNearlyTheLargest) {
  Rng rng(84);
  for (int round = 0; round < 20; ++round) {
    const Vector3d half(rng.uniform(0.02, 0.3), rng.uniform(0.02, 0.3), rng.uniform(0.02, 0.3));
    detail::CoverSolid hull;
    hull.kind = detail::SolidKind::hull;
    hull.X_LS = {testing::random_vector(rng, 1), from_euler(testing::random_vector(rng, 3))};
    for (int k = 0; k < 8; ++k) {
      hull.points.push_back(half.cwiseProduct(
          Vector3d((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1, (k & 4) != 0 ? 1 : -1)));
    }
    std::vector<detail::Facet> facets;
    for (int k = 0; k < 3; ++k) {
      facets.push_back({Vector3d::Unit(k), half[k]});
      facets.push_back({-Vector3d::Unit(k), half[k]});
    }
    hull.facets = detail::Facets(std::move(facets));
    const Sphere ball = detail::Convex(hull).inscribed_ball();
    EXPECT_LE(ball.radius, -hull.signed_distance(ball.center) + 1e-12);
    EXPECT_GE(ball.radius, 0.97 * half.minCoeff());
  }
}

}  // namespace
}  // namespace mjarm
