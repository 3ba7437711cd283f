#include "mjarm/collision/obstacles.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mjarm/collision/random_scene_test.hpp"
#include "mjarm/collision/sphere_set.hpp"

namespace mjarm {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(Obstacles, DistanceIsThatOfTheTextbook) {
  Rng rng(31);
  for (int i = 0; i < 20'000; ++i) {
    const Obstacle solid = testing::random_obstacle(rng, i % 5 == 0);
    const Eigen::Vector3d p = testing::random_vector(rng, 2);
    const double truth = testing::point_distance(solid.shape, solid.X_WO.inverse() * p);
    EXPECT_NEAR(distance(solid, p), std::max(truth, 0.0), 1e-12);
  }
}

std::string fault_of(const Obstacle& obstacle) {
  Obstacles world;
  world.solids = {{"fine", {}, BallShape{1}}, obstacle};
  const Result<void> result = check_obstacles(world);
  if (result) return "";
  EXPECT_EQ(result.error().code, Errc::bad_input);
  EXPECT_EQ(result.error().what.find('\n'), std::string::npos);
  EXPECT_NE(result.error().what.find("\"it\""), std::string::npos);
  return result.error().what;
}

TEST(Obstacles, WhatIsRefused) {
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  EXPECT_EQ(fault_of({"it", {}, BoxShape{{1, 1, 1}}}), "");
  EXPECT_EQ(fault_of({"it", {}, HalfSpaceShape{}}), "");
  EXPECT_EQ(fault_of({"it", {}, CapsuleShape{0.1, 0}}), "");
  for (const double bad : {0.0, -1.0, kNan, kInf, 1e5}) {
    EXPECT_NE(fault_of({"it", {}, BallShape{bad}}), "") << bad;
    EXPECT_NE(fault_of({"it", {}, BoxShape{{1, bad, 1}}}), "") << bad;
    EXPECT_NE(fault_of({"it", {}, CylinderShape{1, bad}}), "") << bad;
    EXPECT_NE(fault_of({"it", {}, CapsuleShape{bad, 1}}), "") << bad;
  }
  EXPECT_NE(fault_of({"it", {}, CapsuleShape{1, -0.1}}), "");
  for (const double bad : {kNan, kInf, -1e5}) {
    EXPECT_NE(fault_of({"it", {{0, bad, 0}, I}, BallShape{1}}), "") << bad;
    EXPECT_NE(fault_of({"it", {{0, 0, 0}, bad * I}, BallShape{1}}), "") << bad;
  }
  EXPECT_NE(fault_of({"it", {{0, 0, 0}, -I}, BallShape{1}}), "");
  EXPECT_NE(fault_of({"it", {{0, 0, 0}, 1.1 * I}, BallShape{1}}), "");
  Obstacles many;
  many.solids.resize(kMostObstacles + 1, {"it", {}, BallShape{1}});
  EXPECT_FALSE(check_obstacles(many).has_value());
}

std::string fault_of(const PointCloud& cloud) {
  Obstacles world;
  world.clouds = {{"fine", {{1, 2, 3}}, 0.1}, cloud};
  const Result<void> result = check_obstacles(world);
  if (result) return "";
  EXPECT_EQ(result.error().code, Errc::bad_input);
  EXPECT_NE(result.error().what.find("1 (\"it\")"), std::string::npos);
  return result.error().what;
}

TEST(Obstacles, WhatIsRefusedOfClouds) {
  EXPECT_EQ(fault_of(PointCloud{"it", {}, 0.1}), "");
  EXPECT_EQ(fault_of(PointCloud{"it", {{0, 0, 0}, {0, 0, 0}}, 0.1}), "");
  for (const double bad : {0.0, -1.0, kNan, kInf, 1e5}) {
    EXPECT_NE(fault_of(PointCloud{"it", {{0, 0, 0}}, bad}), "") << bad;
  }
  for (const double bad : {kNan, kInf, -1e5}) {
    EXPECT_NE(fault_of(PointCloud{"it", {{0, 0, 0}, {0, 0, bad}}, 0.1}).find("point 1"),
              std::string::npos)
        << bad;
  }
  EXPECT_EQ(fault_of(PointCloud{"it", std::vector<Eigen::Vector3d>(kMostPoints - 1), 0.1}), "");
  EXPECT_NE(fault_of(PointCloud{"it", std::vector<Eigen::Vector3d>(kMostPoints), 0.1}), "");
}

TEST(SphereSet, BoundingSphereHoldsAllAndIsTight) {
  Rng rng(32);
  for (int i = 0; i < 300; ++i) {
    std::vector<Sphere> spheres(1 + rng.below(20));
    for (Sphere& s : spheres) s = {testing::random_vector(rng, 0.3), rng.uniform(0.001, 0.2)};
    const Sphere ball = bounding_sphere(spheres);
    double widest = 0;
    for (const Sphere& a : spheres) {
      EXPECT_LE((a.center - ball.center).norm() + a.radius, ball.radius + 1e-12);
      for (const Sphere& b : spheres) {
        widest = std::max(widest, (a.center - b.center).norm() + a.radius + b.radius);
      }
    }
    // Jung: the least ball has at most sqrt(3/8) of the width as radius, and at least half of it.
    EXPECT_LE(ball.radius, 1.05 * std::max(std::sqrt(3.0 / 8) * widest, spheres[0].radius));
  }
}

TEST(SphereSet, WhatIsRefused) {
  const Arm arm = testing::panda();
  const auto fault = [&](const SphereSet& set) {
    const Result<void> result = check_sphere_set(set, arm);
    return result ? std::string() : result.error().what;
  };
  SphereSet good;
  good.links = {{"a", -1, {{{0, 0, 0}, 0.1}}}, {"b", 3, {{{0, 0, 0}, 0.1}}}};
  good.pairs = {{0, 1}};
  EXPECT_EQ(fault(good), "");
  EXPECT_NE(fault({}), "");
  for (const double bad : {0.0, -0.1, kNan, kInf, 11.0}) {
    SphereSet set = good;
    set.links[1].spheres[0].radius = bad;
    EXPECT_NE(fault(set).find("\"b\""), std::string::npos) << bad;
  }
  for (const int joint : {-2, 7}) {
    SphereSet set = good;
    set.links[1].joint = joint;
    EXPECT_NE(fault(set), "");
  }
  for (const std::array<int, 2> pair : {std::array{0, 2}, {-1, 0}, {1, 1}}) {
    SphereSet set = good;
    set.pairs = {pair};
    EXPECT_NE(fault(set), "");
  }
  SphereSet paired = good;
  paired.pairs.resize(kMostSpherePairs + 1, good.pairs[0]);
  EXPECT_NE(fault(paired), "");
  paired.pairs.pop_back();
  EXPECT_EQ(fault(paired), "");
  SphereSet many = good;
  many.links[0].spheres.resize(kMostSpheres, good.links[0].spheres[0]);
  EXPECT_NE(fault(many), "");
}

}  // namespace
}  // namespace mjarm
