#include "mjarm/path/ellipse.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mjarm/core/rng.hpp"
#include "tests/support/constants.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm {
namespace {

using support::kPi;

/// Arc length by Simpson's rule with many cells.
double simpson(double a, double b, double theta) {
  constexpr int kCells = 20000;
  const auto speed = [&](double t) { return std::hypot(a * std::sin(t), b * std::cos(t)); };
  const double h = theta / kCells;
  double sum = speed(0) + speed(theta);
  for (int i = 1; i < kCells; ++i) sum += (i % 2 == 1 ? 4 : 2) * speed(i * h);
  return sum * h / 3;
}

TEST(Ellipse, ArcLengthAgreesWithQuadrature) {
  Rng rng(1);
  for (int i = 0; i < 100; ++i) {
    const double a = rng.uniform(0.1, 1), b = rng.uniform(0.05, 1), theta = rng.uniform(-8, 8);
    EXPECT_NEAR(ellipse_arc_length(a, b, theta), simpson(a, b, theta), 1e-12);
  }
}

TEST(Ellipse, ArcLengthOfKnownCurves) {
  // Circle; the degenerate ellipse that is a line walked there and back; the circumference of
  // semi-axes 2 and 1 (M. Abramowitz and I. Stegun, table 17.1: 8 E(3/4) = 8 * 1.2110560275684594).
  EXPECT_NEAR(ellipse_arc_length(0.3, 0.3, 1.234), 0.3 * 1.234, 1e-15);
  EXPECT_NEAR(ellipse_arc_length(1, 1e-9, 2 * kPi), 4, 1e-12);
  EXPECT_NEAR(ellipse_arc_length(1e-9, 1, 2 * kPi), 4, 1e-12);
  EXPECT_NEAR(ellipse_arc_length(2, 1, 2 * kPi), 8 * 1.2110560275684594, 1e-13);
}

TEST(Ellipse, AngleUndoesArcLength) {
  Rng rng(2);
  for (int i = 0; i < 2000; ++i) {
    const double a = std::pow(10, rng.uniform(-3, 1)), b = std::pow(10, rng.uniform(-3, 1));
    const double theta = rng.uniform(-7, 7);
    const double length = ellipse_arc_length(a, b, theta);
    EXPECT_NEAR(ellipse_arc_length(a, b, ellipse_angle(a, b, length)), length,
                1e-14 * (a + b + std::abs(length)));
  }
}

TEST(Ellipse, PointsLieOnTheEllipse) {
  Rng rng(3);
  for (int i = 0; i < 100; ++i) {
    const Ellipse ellipse{{rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)},
                          rng.uniform(0.1, 1),
                          rng.uniform(0.1, 1),
                          {rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)}};
    const EllipseAxes axes = ellipse_axes(ellipse.normal);
    EXPECT_NEAR(axes.u.cross(axes.v).dot(axes.w), 1, 1e-12);
    EXPECT_GT(axes.w.dot(ellipse.normal), 0);
    for (const Pose& X : ellipse_points(ellipse, 50)) {
      const Eigen::Vector3d d = X.p - ellipse.center;
      EXPECT_NEAR(axes.w.dot(d), 0, 1e-12);
      EXPECT_NEAR(std::hypot(axes.u.dot(d) / ellipse.a, axes.v.dot(d) / ellipse.b), 1, 1e-12);
    }
  }
}

TEST(Ellipse, CountOfPoints) {
  EXPECT_TRUE(ellipse_points({}, 0).empty());
  EXPECT_TRUE(ellipse_points({}, -3).empty());
  EXPECT_EQ(ellipse_points({}, 1).size(), 1U);
  const std::vector<Pose> lap = ellipse_points({}, 9);
  EXPECT_EQ(lap.front().p, lap.back().p);
  EXPECT_GT((ellipse_points({}, 9, false).back().p - lap.back().p).norm(), 0.01);
}

TEST(Ellipse, AgreesWithTheGroundTruth) {
  MJARM_TEST_FILE(file, "ground_truth/ellipse.json.gz");
  const nlohmann::json cases = support::load_json(file).at("cases");
  int closed = 0;
  for (const auto& entry : cases) {
    const auto vec = [](const nlohmann::json& v) {
      return Eigen::Vector3d(v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>());
    };
    const Ellipse ellipse{vec(entry.at("center")), entry.at("a").get<double>(),
                          entry.at("b").get<double>(), vec(entry.at("plane_normal"))};
    const EllipseAxes axes = ellipse_axes(ellipse.normal);
    EXPECT_LT((axes.u - vec(entry.at("u"))).norm(), 1e-12);
    EXPECT_LT((axes.v - vec(entry.at("v"))).norm(), 1e-12);
    EXPECT_LT((axes.w - vec(entry.at("w"))).norm(), 1e-12);
    const bool endpoint = entry.at("endpoint").get<bool>();
    closed += endpoint ? 1 : 0;
    const std::vector<Pose> points =
        ellipse_points(ellipse, entry.at("num_points").get<int>(), endpoint);
    ASSERT_EQ(points.size(), entry.at("points").size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_LT((points[i].p - vec(entry.at("points")[i])).norm(), 1e-12);
    }
  }
  EXPECT_GT(closed, 0);
  EXPECT_LT(closed, static_cast<int>(cases.size()));
}

}  // namespace
}  // namespace mjarm
