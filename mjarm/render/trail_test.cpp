#include "mjarm/render/trail.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace mjarm::render {
namespace {

TEST(Trail, KeepsTheNewestOfALongWay) {
  Trail trail({.max_points = 100, .spacing = 0.01});
  for (int i = 0; i < 100000; ++i) trail.add({0.001 * i, 0, 0});
  EXPECT_EQ(trail.size(), 100U);
  const std::vector<Eigen::Vector3d> points = trail.points();
  EXPECT_NEAR(points.back().x(), 99.999, 1e-9);
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    EXPECT_NEAR(points[i].x() - points[i - 1].x(), 0.01, 1.1e-3);
  }
}

TEST(Trail, AlwaysReachesThePoint) {
  Trail trail({.spacing = 0.01});
  trail.add({0, 0, 0});
  EXPECT_EQ(trail.points().size(), 1U);
  trail.add({0.004, 0, 0});
  EXPECT_EQ(trail.size(), 1U);
  EXPECT_EQ(trail.points().back(), Eigen::Vector3d(0.004, 0, 0));
  trail.add({std::nan(""), 0, 0});
  EXPECT_EQ(trail.points().back(), Eigen::Vector3d(0.004, 0, 0));
  trail.clear();
  EXPECT_TRUE(trail.points().empty());
  Overlay overlay;
  trail.draw(overlay);
  EXPECT_EQ(shapes_of(overlay), 0U);
  trail.add({1, 0, 0});
  EXPECT_EQ(trail.points().size(), 1U);
}

TEST(Trail, StandingStillCostsNothing) {
  Trail trail;
  for (int i = 0; i < 100000; ++i) trail.add({1e-5 * std::sin(i), 0, 0});
  EXPECT_EQ(trail.size(), 1U);
}

TEST(Trail, IsALineOrBalls) {
  Trail trail({.spacing = 0.0015, .ball_spacing = 0.01});
  for (int i = 0; i <= 1000; ++i) trail.add({0.001 * i, 0, 0});
  Overlay overlay;
  trail.draw(overlay);
  ASSERT_EQ(overlay.lines.size(), 1U);
  EXPECT_TRUE(overlay.spheres.empty());
  EXPECT_NEAR(static_cast<double>(overlay.lines[0].points_W.size()), 501, 2);
  EXPECT_EQ(overlay.lines[0].look, LineLook::thin);
  trail.set_balls(true);
  Overlay balls;
  trail.draw(balls);
  EXPECT_TRUE(balls.lines.empty());
  EXPECT_NEAR(static_cast<double>(balls.spheres.size()), 101, 20);
  for (std::size_t i = 1; i < balls.spheres.size(); ++i) {
    EXPECT_GE(balls.spheres[i].p_W.x() - balls.spheres[i - 1].p_W.x(), 0.01 - 1e-9);
  }
}

}  // namespace
}  // namespace mjarm::render
