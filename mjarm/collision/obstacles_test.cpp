#include "mjarm/collision/obstacles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mjarm/collision/random_scene_test.hpp"
#include "mjarm/collision/sphere_set.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"

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

TEST(Obstacles, DistanceToCompositesIsThatOfTheTextbook) {
  Rng rng(33);
  int inside = 0;
  for (int i = 0; i < 600; ++i) {
    const Obstacle solid = testing::random_composite(rng);
    Obstacles world;
    world.solids = {solid};
    ASSERT_TRUE(check_obstacles(world).has_value()) << check_obstacles(world).error().what;
    for (int k = 0; k < 20; ++k) {
      const Eigen::Vector3d p = solid.X_WO.p + testing::random_vector(rng, k < 10 ? 0.1 : 0.7);
      const double truth = testing::point_distance(solid.shape, solid.X_WO.inverse() * p);
      EXPECT_NEAR(distance(solid, p), truth, 1e-9);
      inside += truth == 0 ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 1000);
}

/// Bounds of the distance to the convex hull of points: from above by a point of the hull, from
/// below by the plane across the way there (E. Gilbert, 1966).
std::array<double, 2> hull_distance(const std::vector<Eigen::Vector3d>& points,
                                    const Eigen::Vector3d& p) {
  Eigen::Vector3d at = points.front();
  double lower = 0;
  for (int round = 0; round < 3000; ++round) {
    const Eigen::Vector3d way = p - at;
    const auto& far = *std::max_element(points.begin(), points.end(),
                                        [&](auto& a, auto& b) { return way.dot(a) < way.dot(b); });
    if (way.norm() < 1e-9) break;
    lower = std::max(lower, way.dot(p - far) / way.norm());
    const Eigen::Vector3d step = far - at;
    if (step.norm() < 1e-12) break;
    at += std::clamp(step.dot(way) / step.squaredNorm(), 0.0, 1.0) * step;
  }
  return {lower, (p - at).norm()};
}

TEST(Obstacles, PolytopesHoldTheirPointsAndAreTight) {
  Rng rng(34);
  double worst = 1;
  for (int i = 0; i < testing::rounds(105, 3000); ++i) {
    const Eigen::Vector3d half(rng.uniform(0, 1), i % 7 == 0 ? 0 : rng.uniform(0, 1),
                               i % 21 == 0 ? 0 : rng.uniform(0, 1));
    std::vector<Eigen::Vector3d> points;
    for (std::uint64_t k = i % 35 == 0 ? 1 : 4 + rng.below(14); k > 0; --k) {
      points.push_back(half.cwiseProduct(testing::random_vector(rng, 0.5)));
    }
    const PolytopeShape shape = make_polytope(points).value();
    EXPECT_LE(shape.planes.size(), kMaxPlanes);
    const Obstacle solid{"", {}, shape};
    for (const Eigen::Vector3d& point : points) EXPECT_LT(distance(solid, point), 1e-12);
    for (int k = 0; k < 20; ++k) {
      const Eigen::Vector3d p = testing::random_vector(rng, k % 2 == 0 ? 0.6 : 2);
      const auto [lower, upper] = hull_distance(points, p);
      EXPECT_LE(distance(solid, p), upper + 1e-9);
      if (lower > 1e-3) worst = std::min(worst, distance(solid, p) / lower);
    }
  }
  EXPECT_GT(worst, 0.9);
  RecordProperty("worst", std::to_string(worst));
}

TEST(Obstacles, PolytopesOfManyPointsHoldThem) {
  Rng rng(35);
  for (const int count : {50, 500, 5000}) {
    std::vector<Eigen::Vector3d> points;
    for (int k = 0; k < count; ++k) {
      points.push_back(testing::random_vector(rng, 1).normalized() * rng.uniform(0.9, 1));
    }
    const Obstacle solid{"", {}, make_polytope(points).value()};
    for (const Eigen::Vector3d& point : points) EXPECT_LT(distance(solid, point), 1e-12);
    EXPECT_GT(distance(solid, {0, 0, 2}), 0.9);
  }
  EXPECT_FALSE(make_polytope({}).has_value());
  const std::vector<Eigen::Vector3d> bad{{0, 0, 0}, {0, kNan, 0}};
  EXPECT_FALSE(make_polytope(bad).has_value());
  const std::vector<Eigen::Vector3d> same(10'000, {1, 2, 3});
  EXPECT_TRUE(make_polytope(same).has_value());
  EXPECT_FALSE(make_polytope(std::vector<Eigen::Vector3d>(10'001)).has_value());
}

TEST(Obstacles, ClosedMeshes) {
  Rng rng(36);
  MeshShape mesh = testing::random_closed_mesh(rng, 1);
  EXPECT_TRUE(is_closed(mesh));
  MeshShape soup;  // the same, each face with corners of its own
  for (const auto& face : mesh.faces) {
    const int first = static_cast<int>(soup.vertices.size());
    for (const int v : face) soup.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
    soup.faces.push_back({first, first + 1, first + 2});
  }
  EXPECT_TRUE(is_closed(soup));
  mesh.faces.pop_back();
  EXPECT_FALSE(is_closed(mesh));
  EXPECT_FALSE(is_closed({}));
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
  many.solids.resize(kMaxObstacles + 1, {"it", {}, BallShape{1}});
  EXPECT_FALSE(check_obstacles(many).has_value());
}

TEST(Obstacles, WhatIsRefusedOfComposites) {
  const MeshShape triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, false};
  EXPECT_EQ(fault_of({"it", {}, triangle}), "");
  MeshShape mesh = triangle;
  mesh.solid = true;
  EXPECT_NE(fault_of({"it", {}, mesh}), "");
  for (const int bad : {-1, 3}) {
    mesh = triangle;
    mesh.faces.push_back({0, bad, 2});
    EXPECT_NE(fault_of({"it", {}, mesh}).find("face 1"), std::string::npos);
  }
  mesh = triangle;
  mesh.faces.resize(kMaxPieces, mesh.faces[0]);
  EXPECT_NE(fault_of({"it", {}, mesh}), "");  // with the obstacle before it
  mesh.faces.clear();
  EXPECT_NE(fault_of({"it", {}, mesh}), "");
  const HeightFieldShape field{2, 3, {1, 1}, 0, {1, 1, 1, 1, 1, 1}};
  EXPECT_EQ(fault_of({"it", {}, field}), "");
  const PolytopeShape cube =
      make_polytope(std::vector<Eigen::Vector3d>{{0, 0, 0}, {1, 1, 1}}).value();
  EXPECT_EQ(fault_of({"it", {}, cube}), "");
  for (const double bad : {kNan, kInf, -1e5}) {
    mesh = triangle;
    mesh.vertices[2].y() = bad;
    EXPECT_NE(fault_of({"it", {}, mesh}).find("vertex 2"), std::string::npos);
    HeightFieldShape rough = field;
    rough.heights[4] = bad;
    EXPECT_NE(fault_of({"it", {}, rough}).find("height 4"), std::string::npos);
    rough = field;
    rough.half.x() = bad;
    EXPECT_NE(fault_of({"it", {}, rough}), "");
    rough = field;
    rough.bottom = bad;
    EXPECT_NE(fault_of({"it", {}, rough}), "");
    PolytopeShape cut = cube;
    cut.planes[0].x() = bad;
    EXPECT_NE(fault_of({"it", {}, cut}), "");
    cut = cube;
    cut.low.x() = bad;
    EXPECT_NE(fault_of({"it", {}, cut}), "");
  }
  for (const int rows : {0, 1, 3, -2, 1 << 30}) {
    HeightFieldShape rough = field;
    rough.rows = rows;
    EXPECT_NE(fault_of({"it", {}, rough}), "") << rows;
    rough = field;
    rough.cols = rows == 3 ? 2 : rows;
    EXPECT_NE(fault_of({"it", {}, rough}), "") << rows;
  }
  PolytopeShape open = cube;
  open.planes.clear();
  EXPECT_NE(fault_of({"it", {}, open}), "");
  open.planes.resize(kMaxPlanes + 1, cube.planes[0]);
  EXPECT_NE(fault_of({"it", {}, open}), "");
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
  EXPECT_EQ(fault_of(PointCloud{"it", std::vector<Eigen::Vector3d>(kMaxPoints - 1), 0.1}), "");
  EXPECT_NE(fault_of(PointCloud{"it", std::vector<Eigen::Vector3d>(kMaxPoints), 0.1}), "");
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
  paired.pairs.resize(kMaxSpherePairs + 1, good.pairs[0]);
  EXPECT_NE(fault(paired), "");
  paired.pairs.pop_back();
  EXPECT_EQ(fault(paired), "");
  SphereSet many = good;
  many.links[0].spheres.resize(kMaxSpheres, good.links[0].spheres[0]);
  EXPECT_NE(fault(many), "");
}

TEST(CheckObstacles, IgnoredPairsMustExist) {
  Obstacles world{{{"ball", {}, BallShape{0.1}}}};
  world.ignored = {{0, 0}, {2, 0}};
  EXPECT_TRUE(check_obstacles(world).has_value());
  EXPECT_TRUE(check_obstacles(world, 3).has_value());
  EXPECT_FALSE(check_obstacles(world, 2).has_value());
  for (const IgnoredPair pair : {IgnoredPair{0, 1}, IgnoredPair{-1, 0}, IgnoredPair{0, -1}}) {
    world.ignored = {pair};
    const Result<void> result = check_obstacles(world);
    ASSERT_FALSE(result.has_value());
    EXPECT_NE(result.error().what.find("ignored pair 0"), std::string::npos);
  }
}

}  // namespace
}  // namespace mjarm
