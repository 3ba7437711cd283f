#include "mjarm/planning/grasps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mjarm/core/rotation.hpp"

namespace mjarm {
namespace {

using Eigen::Vector3d;

const Jaws kJaws{.opening = 0.085, .half_width = 0.01, .tips = 0.01, .palm = 0.05};

ObjectShape shape_of(ShapePart part) {
  ObjectShape out;
  out.parts.push_back(std::move(part));
  return out;
}

/// A bar of three sides, lying along z, its triangles cut as they come.
ShapePart prism(double side, double half_length) {
  ShapePart out{.kind = ShapePart::Kind::hull, .X_BG = {}};
  const double radius = side / std::sqrt(3.0);
  for (const double z : {-half_length, half_length}) {
    for (int k = 0; k < 3; ++k) {
      const double angle = 2 * std::numbers::pi * k / 3;
      out.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
    }
  }
  out.faces = {{0, 2, 1}, {3, 4, 5}};
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    out.faces.push_back({k, next, next + 3});
    out.faces.push_back({k, next + 3, k + 3});
  }
  return out;
}

Vector3d approach(const Grasp& grasp) { return grasp.X_BT.R * kJaws.approach_T; }
Vector3d close(const Grasp& grasp) { return grasp.X_BT.R * kJaws.close_T; }

TEST(Grasps, OfABoxAreAcrossItsSides) {
  const ShapePart box{.kind = ShapePart::Kind::box, .X_BG = {}, .size = {0.02, 0.025, 0.06}};
  const Grasps grasps = find_grasps(shape_of(box), kJaws);
  EXPECT_DOUBLE_EQ(grasps.narrowest, 0.04);
  ASSERT_FALSE(grasps.all.empty());
  for (const Grasp& one : grasps.all) {
    // 12 cm are more than the gripper opens.
    EXPECT_LT(std::abs(close(one).z()), 1e-12);
    EXPECT_NEAR(one.width, std::abs(close(one).x()) > 0.5 ? 0.04 : 0.05, 1e-12);
  }
}

TEST(Grasps, AnApproachThatIsWantedIsAmongThoseOfEveryClosing) {
  const Vector3d wanted = Vector3d(0.3, -0.5, 0.2).normalized();
  for (const ShapePart& part :
       {prism(0.05, 0.035),
        ShapePart{.kind = ShapePart::Kind::cylinder, .X_BG = {}, .size = {0.03, 0.05, 0}}}) {
    const Grasps grasps = find_grasps(shape_of(part), kJaws, {.approach_B = wanted});
    ASSERT_FALSE(grasps.all.empty());
    for (const Grasp& one : grasps.all) {
      const Vector3d square = (wanted - wanted.dot(close(one)) * close(one)).normalized();
      EXPECT_TRUE(std::ranges::any_of(grasps.all, [&](const Grasp& other) {
        return std::abs(close(other).dot(close(one))) > 1 - 1e-9 &&
               approach(other).dot(square) > 1 - 1e-9;
      })) << close(one).transpose();
    }
  }
}

TEST(Grasps, FlatEndsOfAHullAreHeldInTheMiddle) {
  const ObjectShape shape = shape_of(prism(0.05, 0.035));
  const Grasps grasps = find_grasps(shape, kJaws);
  const auto along = std::ranges::find_if(
      grasps.all, [](const Grasp& one) { return std::abs(close(one).z()) > 0.99; });
  ASSERT_NE(along, grasps.all.end());
  EXPECT_LT(along->off_center, 1e-12);
  EXPECT_NEAR(along->width, 0.07, 1e-12);
}

}  // namespace
}  // namespace mjarm
