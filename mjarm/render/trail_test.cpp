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

/// A page that plays what is over needs to know when the trail came where.
TEST(Trail, TellsWhenItCameToEachPoint) {
  Trail trail({.spacing = 0.0015});
  for (int i = 0; i <= 100; ++i) {
    if (i == 50) trail.set_pen(Pen::travel);
    trail.add({0.001 * i, 0, 0}, 0.1 * i);
  }
  Overlay overlay;
  trail.draw(overlay);
  ASSERT_EQ(overlay.lines.size(), 2U);
  for (const OverlayLine& line : overlay.lines) {
    ASSERT_EQ(line.times.size(), line.points_W.size());
    for (std::size_t i = 0; i < line.times.size(); ++i) {
      EXPECT_NEAR(line.times[i], 100 * line.points_W[i].x(), 1e-9);
    }
  }
  EXPECT_EQ(overlay.lines[0].times.back(), overlay.lines[1].times.front());
}

/// Two strokes with the pen up between them are two lines; a joint move between them is pale and
/// thin, and meets both.
TEST(Trail, ThePenLeavesGapsAndPaleWays) {
  Trail trail({.spacing = 0.01});
  const auto go = [&trail](double from, double to) {
    for (int i = 0; i <= 100; ++i) trail.add({from + (to - from) * i / 100, 0, 0});
  };
  go(0, 1);
  trail.set_pen(Pen::up);
  go(1, 2);
  trail.set_pen(Pen::down);
  go(2, 3);
  trail.set_pen(Pen::travel);
  go(3, 4);
  trail.set_pen(Pen::down);
  go(4, 5);
  Overlay overlay;
  trail.draw(overlay);
  ASSERT_EQ(overlay.lines.size(), 4U);
  const double ends[][2] = {{0, 1}, {2, 3}, {3, 4}, {4, 5}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(overlay.lines[i].points_W.front().x(), ends[i][0], 1e-9) << i;
    EXPECT_NEAR(overlay.lines[i].points_W.back().x(), ends[i][1], 1e-9) << i;
  }
  EXPECT_LT(overlay.lines[2].width, 0.5 * overlay.lines[1].width);
  EXPECT_GT(overlay.lines[2].color.r, overlay.lines[1].color.r + 0.3F) << "pale";
  EXPECT_EQ(overlay.lines[3].width, overlay.lines[1].width);
  trail.set_balls(true);
  Overlay balls;
  trail.draw(balls);
  for (const OverlaySphere& ball : balls.spheres) {
    const double x = ball.p_W.x();
    EXPECT_TRUE(x <= 1.001 || (x >= 1.999 && x <= 3.001) || x >= 3.999) << x;
  }
}

TEST(Trail, APenThatIsUpAtFirstDrawsNothing) {
  Trail trail({.pen = Pen::up});
  trail.add({0, 0, 0});
  EXPECT_EQ(trail.size(), 0U);
  trail.set_pen(Pen::travel);
  trail.set_pen(Pen::down);
  trail.add({1, 0, 0});
  trail.add({2, 0, 0});
  Overlay overlay;
  trail.draw(overlay);
  ASSERT_EQ(overlay.lines.size(), 1U);
  EXPECT_EQ(overlay.lines[0].points_W.front().x(), 1);
}

}  // namespace
}  // namespace mjarm::render
