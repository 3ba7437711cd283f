#include <gtest/gtest.h>

#include "mjarm/collision/edge_check.hpp"
#include "mjarm/collision/fast_oracle_test.hpp"
#include "mjarm/collision/verify_edge.hpp"

/// Solids that are hardly there, in one place, or the same as others; edges at the very limits.
namespace mjarm {
namespace {

using testing::kLevels;
using testing::random_rows;

/// A ball of 0.1 m on a slide along x, from -1 to 1.
struct OneSlide {
  Arm arm = testing::make_arm("slide", {{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, -1, 1, JointType::slide}},
                              Pose());
  SphereSet set;
  OneSlide() { set.links = {{"ball", 0, {{Eigen::Vector3d::Zero(), 0.1}}}}; }
  [[nodiscard]] FastChecker with(const Obstacles& world, SimdLevel level = simd_level()) const {
    return FastChecker::create(FastRobot::create(arm, set).value(), world, level).value();
  }
};

Obstacle solid_at(double x, ObstacleShape shape) {
  return {"it", {{x, 0, 0}, Eigen::Matrix3d::Identity()}, std::move(shape)};
}

/// Points that have no room between them, as a polytope.
Obstacle hull_at(double x, const std::vector<Eigen::Vector3d>& points) {
  return solid_at(x, make_polytope(points).value());
}

TEST(DegenerateObstacles, HardlyThereTheyAreStillMet) {
  const OneSlide slide;
  constexpr double kPlace = 0.5, kLeast = 1e-9;
  const std::vector<Eigen::Vector3d> one{{0, 0, 0}}, line{{0, -0.2, 0}, {0, 0.2, 0}},
      plane{{0, -0.2, -0.2}, {0, 0.2, -0.2}, {0, 0, 0.2}};
  const MeshShape point{{{0, 0, 0}}, {{0, 0, 0}}};
  const MeshShape needle{{{0, -0.2, 0}, {0, 0.2, 0}}, {{0, 1, 0}}};
  Obstacles points;
  points.clouds = {{"points", {{kPlace, 0, 0}, {kPlace, 0, 0}}, kLeast}};
  std::vector<Obstacles> worlds{points};
  for (const Obstacle& solid :
       {solid_at(kPlace, BallShape{kLeast}), solid_at(kPlace, CapsuleShape{kLeast, 0}),
        solid_at(kPlace, CapsuleShape{kLeast, 0.3}),
        solid_at(kPlace, BoxShape{{kLeast, kLeast, kLeast}}),
        solid_at(kPlace, BoxShape{{kLeast, 1, 1}}), solid_at(kPlace, CylinderShape{kLeast, kLeast}),
        hull_at(kPlace, one), hull_at(kPlace, line), hull_at(kPlace, plane),
        solid_at(kPlace, point), solid_at(kPlace, needle)}) {
    worlds.push_back({{solid}});
  }
  for (std::size_t i = 0; i < worlds.size(); ++i) {
    for (const SimdLevel level : kLevels) {
      SCOPED_TRACE(i);
      const FastChecker checker = slide.with(worlds[i], level);
      const auto is_free = [&](double q) { return checker.is_free({&q, 1}); };
      EXPECT_TRUE(is_free(kPlace - 0.102));
      EXPECT_TRUE(is_free(kPlace + 0.102));
      EXPECT_FALSE(is_free(kPlace - 0.0999));
      EXPECT_FALSE(is_free(kPlace + 0.0999));
      const std::vector<double> q0{-1}, before{0.39}, after{0.61}, q1{1};
      EXPECT_EQ(check_edge(checker, q0, before).verdict, EdgeVerdict::free);
      EXPECT_EQ(check_edge(checker, after, q1).verdict, EdgeVerdict::free);
      const EdgeResult hit = check_edge(checker, q0, q1);
      EXPECT_EQ(hit.verdict, EdgeVerdict::hit);
      EXPECT_NEAR(2 * hit.t - 1, kPlace, 0.101);
      const auto found = verify_edge(slide.arm, slide.set, worlds[i], q0, q1).value();
      EXPECT_EQ(found.verdict, EdgeVerdict::hit);
      EXPECT_NEAR(2 * found.t - 1, kPlace, 0.1001);
    }
  }
}

TEST(DegenerateObstacles, OneSolidManyTimesIsOneSolid) {
  Rng rng(91);
  for (int round = 0; round < 20; ++round) {
    const Arm arm = testing::random_arm(2 + round % 6, rng);
    const SphereSet set = testing::random_spheres(arm, rng);
    const FastRobot robot = FastRobot::create(arm, set).value();
    const Obstacles one = testing::random_world(rng, 1);
    Obstacles many;  // enough of them stand in a tree instead of in lists
    for (int k = 0; k < 150; ++k) many.solids.push_back(one.solids.front());
    const std::vector<double> rows = random_rows(arm, rng, 50);
    std::vector<SphereClearance> of_one(50), of_many(50);
    FastChecker::create(robot, one).value().clearances(rows, of_one);
    FastChecker::create(robot, many).value().clearances(rows, of_many);
    for (std::size_t k = 0; k < 50; ++k) {
      if (of_one[k].distance < 1e-3 && of_many[k].distance < 1e-3) continue;
      EXPECT_NEAR(of_one[k].distance, of_many[k].distance, 1e-4);
    }
  }
}

TEST(DegenerateObstacles, SolidsSayTheSameInOtherWords) {
  Rng rng(92);
  for (int round = 0; round < 300; ++round) {
    const Pose X{testing::random_vector(rng, 1), from_euler(testing::random_vector(rng, 3))};
    const Eigen::Vector3d p = testing::random_vector(rng, 2);
    const double radius = rng.uniform(0.01, 0.5);
    EXPECT_NEAR(distance(Obstacle{"", X, BallShape{radius}}, p),
                distance(Obstacle{"", X, CapsuleShape{radius, 0}}, p), 1e-12);
    const Eigen::Vector3d half = testing::random_vector(rng, 0.5).cwiseAbs().array() + 0.01;
    std::vector<Eigen::Vector3d> corners;
    for (int k = 0; k < 8; ++k) {
      corners.push_back(half.cwiseProduct(
          Eigen::Vector3d(k & 1 ? 1.0 : -1.0, k & 2 ? 1.0 : -1.0, k & 4 ? 1.0 : -1.0)));
    }
    const double box = distance(Obstacle{"", X, BoxShape{half}}, p);
    const double hull = distance(Obstacle{"", X, make_polytope(corners).value()}, p);
    EXPECT_LE(hull, box + 1e-9);
    EXPECT_GE(hull, 0.9 * box - 1e-9);
    PointCloud cloud{"", {X.p}, radius};
    EXPECT_NEAR(distance(cloud, p), distance(Obstacle{"", X, BallShape{radius}}, p), 1e-12);
    cloud.points_W.clear();
    EXPECT_EQ(distance(cloud, p), std::numeric_limits<double>::infinity());
  }
}

TEST(EdgesAtTheLimits, BothChecksTakeTheWholeRange) {
  const OneSlide slide;
  const FastChecker checker = slide.with({});
  const std::vector<double> low{-1}, high{1}, beyond{1.001};
  for (const SimdLevel level : kLevels) {
    const FastChecker other = slide.with({}, level);
    EXPECT_EQ(check_edge(other, low, high).verdict, EdgeVerdict::free);
    EXPECT_EQ(check_edge(other, high, low).verdict, EdgeVerdict::free);
    EXPECT_EQ(check_edge(other, low, low).verdict, EdgeVerdict::free);
    EXPECT_EQ(check_edge(other, low, beyond).verdict, EdgeVerdict::outside);
    EXPECT_EQ(check_edge(other, beyond, low).t, 0);
  }
  const auto proof = certify_edge(checker, low, high);
  ASSERT_TRUE(proof.has_value());
  EXPECT_EQ(proof->nearest.link, -1) << "nothing is there to be near to";
  EXPECT_EQ(proof->nearest.distance, 1);
  const auto refused = certify_edge(checker, low, beyond);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().verdict, EdgeVerdict::outside);
  EXPECT_EQ(refused.error().t, 1);
  EXPECT_EQ(refused.error().stations, 0);
  const auto second = verify_edge(slide.arm, slide.set, {}, low, high).value();
  EXPECT_EQ(second.verdict, EdgeVerdict::free);
  EXPECT_EQ(second.distance, std::numeric_limits<double>::infinity());
  EXPECT_EQ(verify_edge(slide.arm, slide.set, {}, low, beyond)->verdict, EdgeVerdict::outside);
}

TEST(EdgesAtTheLimits, FinerResolutionProvesMoreAndNeverTurnsAVerdict) {
  const OneSlide slide;
  const std::vector<double> low{-1}, high{1};
  // A wall beside the way, ever nearer: at last nothing but its touch is left to be seen.
  for (const double gap : {0.1, 0.01, 2e-3, 1e-3}) {
    Obstacles world;
    world.solids = {
        {"wall", {{0, 1.1 + gap, 0}, Eigen::Matrix3d::Identity()}, BoxShape{{2, 1, 2}}}};
    const FastChecker checker = slide.with(world);
    int stations = 0;
    for (const double resolution : {1.0, 0.1, 1e-3}) {
      const EdgeResult result = check_edge(checker, low, high, {.resolution = resolution});
      EXPECT_NE(result.verdict, EdgeVerdict::hit) << gap;
      EXPECT_GE(result.stations, stations);
      stations = result.stations;
    }
    EXPECT_EQ(check_edge(checker, low, high).verdict, EdgeVerdict::free) << gap;
  }
}

}  // namespace
}  // namespace mjarm
