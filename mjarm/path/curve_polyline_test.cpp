#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/path/poses_test.hpp"
#include "tests/support/rounds.hpp"

namespace mjarm {
namespace {

using testing::at_point;
using testing::random_vec;
using Vec = Eigen::Vector3d;

std::vector<Pose> random_poses(Rng& rng, int n, double size = 1) {
  std::vector<Pose> poses;
  for (int i = 0; i < n; ++i)
    poses.push_back({random_vec(rng, size), from_euler(random_vec(rng, 3))});
  return poses;
}
/// The same without corners that nearly turn back.
std::vector<Pose> gentle_poses(Rng& rng, int n, double size = 1) {
  while (true) {
    std::vector<Pose> poses = random_poses(rng, n, size);
    bool gentle = true;
    for (std::size_t i = 2; i < poses.size(); ++i) {
      gentle = gentle && (poses[i].p - poses[i - 1].p)
                                 .normalized()
                                 .dot((poses[i - 1].p - poses[i - 2].p).normalized()) > -0.9;
    }
    if (gentle) return poses;
  }
}
/// Largest change of the tool's direction and of its rate of turn between neighbours of `n` samples
/// with spacing `h`, from `s0` on.
struct Change {
  double direction = 0;
  double rate = 0;
};
Change largest_change(const Curve& curve, double s0, double h, int n) {
  Change change;
  for (int i = 0; i < n; ++i) {
    const Pose X0 = curve.at(s0 + i * h), X1 = curve.at(s0 + (i + 1) * h),
               X2 = curve.at(s0 + (i + 2) * h);
    change.direction = std::max(change.direction, (X2.p - 2 * X1.p + X0.p).norm() / h);
    change.rate = std::max(
        change.rate,
        (rotation_log(X1.R.transpose() * X2.R) - rotation_log(X0.R.transpose() * X1.R)).norm() / h);
  }
  return change;
}

TEST(BlendedPolyline, LeavesItsLegsOnlyWithinTheRadius) {
  Rng rng(1);
  for (int i = 0; i < 200; ++i) {
    const std::vector<Pose> points = random_poses(rng, 3 + i % 6);
    const double blend = rng.uniform(0.001, 0.6);
    const Curve sharp = *Curve::polyline(points), curve = *Curve::polyline(points, blend);
    ASSERT_EQ(curve.blends().size(), points.size() - 2);
    double largest = 0;
    for (int k = 0; k <= 2000; ++k) {
      const Pose X = curve.at(curve.end() * k / 2000);
      const double away = sharp.nearest(X.p).distance;
      largest = std::max(largest, away);
      if (away < 1e-9) continue;
      // Off the legs, so within the radius used at some corner.
      const bool near_corner =
          std::any_of(curve.blends().begin(), curve.blends().end(), [&](const CurveBlend& b) {
            return (X.p - points[b.point].p).norm() <= b.radius * (1 + 1e-9);
          });
      ASSERT_TRUE(near_corner) << i << " " << k;
    }
    EXPECT_LE(largest, blend);
    EXPECT_GT(largest, 0);
    EXPECT_LE(curve.length(), sharp.length());
    EXPECT_LT((curve.at(0).p - points.front().p).norm(), 1e-12);
    EXPECT_LT((curve.at(curve.end()).p - points.back().p).norm(), 1e-9);
    EXPECT_LT(angle_between(curve.at(curve.end()).R, points.back().R), 1e-6);
  }
}

TEST(BlendedPolyline, TellsTheRadiusAndTheDistanceOfEveryCorner) {
  Rng rng(2);
  for (int i = 0; i < testing::rounds(25, 1000); ++i) {
    const std::vector<Pose> points = gentle_poses(rng, 5);
    const double blend = rng.uniform(0.01, 0.8);
    const Curve curve = *Curve::polyline(points, blend);
    for (std::size_t c = 1; c < 4; ++c) {
      const CurveBlend& b = curve.blends()[c - 1];
      const double before = (points[c].p - points[c - 1].p).norm() * (c == 1 ? 1 : 0.5);
      const double after = (points[c + 1].p - points[c].p).norm() * (c == 3 ? 1 : 0.5);
      EXPECT_EQ(b.point, c);
      EXPECT_DOUBLE_EQ(b.radius, std::min({blend, before, after}));
      EXPECT_GT(b.distance, 0);
      // Other legs may pass by the corner even nearer.
      const Curve alone =
          *Curve::polyline(std::vector<Pose>(points.begin() + static_cast<std::ptrdiff_t>(c) - 1,
                                             points.begin() + static_cast<std::ptrdiff_t>(c) + 2),
                           b.radius);
      double least = 1e9, turn = 0;
      const double from = alone.nearest(points[c].p).s - b.radius;
      for (int k = 0; k <= 4000; ++k) {
        const Pose X = alone.at(from + 2 * b.radius * k / 4000);
        const double distance = (X.p - points[c].p).norm();
        if (distance < least) {
          least = distance;
          turn = angle_between(X.R, points[c].R);
        }
      }
      EXPECT_NEAR(b.distance, least, 1e-3 * b.radius);
      EXPECT_NEAR(b.turn, turn, 0.05);
      EXPECT_NEAR(alone.nearest(points[c].p).distance, b.distance, 1e-12);
    }
  }
}

TEST(BlendedPolyline, TurnsPositionAndRotationWithoutJumps) {
  Rng rng(3);
  for (int i = 0; i < testing::rounds(15, 400); ++i) {
    const double scale = std::pow(10, rng.uniform(-5, 4));
    const std::vector<Pose> points = gentle_poses(rng, 3, scale);
    const double leg =
        std::min((points[1].p - points[0].p).norm(), (points[2].p - points[1].p).norm());
    const double blend = leg * rng.uniform(0.1, 1.5);
    const Curve curve = *Curve::polyline(points, blend);
    EXPECT_THAT(curve.corners(), ::testing::SizeIs(2));
    // Over the whole bend and a little of the legs: a quarter of the spacing, a quarter of the
    // changes.
    const double radius = curve.blends().at(0).radius;
    const double middle = curve.nearest(points[1].p).s;
    const double from = std::max(0.0, middle - 1.1 * radius);
    const double way = std::min(curve.end(), middle + 1.1 * radius) - from;
    const Change coarse = largest_change(curve, from, way / 1000, 998);
    const Change fine = largest_change(curve, from, way / 4000, 3998);
    EXPECT_LT(fine.direction, 0.35 * coarse.direction + 1e-6);
    EXPECT_LT(fine.rate * scale, 0.35 * coarse.rate * scale + 1e-6);
    // The check can fail: a sharp corner jumps as much at any spacing.
    const Curve sharp = *Curve::polyline(points);
    const double corner = sharp.corners().at(1);
    EXPECT_GT(
        largest_change(sharp, corner - 10.5e-4 * leg, 1e-4 * leg, 20).direction,
        0.4 * ((points[2].p - points[1].p).normalized() - (points[1].p - points[0].p).normalized())
                  .norm());
  }
}

TEST(BlendedPolyline, KeepsCornersThatCannotBeRounded) {
  const Pose zero = at_point(0, 0, 0), one = at_point(1, 0, 0);
  const Curve there_and_back = *Curve::polyline(std::vector<Pose>{zero, one, zero}, 0.1);
  EXPECT_THAT(there_and_back.corners(), ::testing::ElementsAre(0, 1, 2));
  EXPECT_EQ(there_and_back.blends().at(0).radius, 0);
  EXPECT_EQ(there_and_back.blends().at(0).distance, 0);
  const Pose turned{Vec(1, 0, 0), from_euler({0, 0, 0.5})};
  const Curve spot = *Curve::polyline(std::vector<Pose>{zero, one, turned, at_point(1, 1, 0)}, 0.1);
  EXPECT_THAT(spot.corners(), ::testing::SizeIs(4));
  EXPECT_EQ(spot.blends().size(), 2U);
  // No corner, nothing to round.
  const Curve straight = *Curve::polyline(std::vector<Pose>{zero, one, at_point(3, 0, 0)}, 0.1);
  EXPECT_THAT(straight.blends(), ::testing::IsEmpty());
  EXPECT_EQ(straight.length(), 3);
  // A straight way on which the tool begins to turn.
  const Curve twist =
      *Curve::polyline(std::vector<Pose>{zero, one, {Vec(2, 0, 0), from_euler({0.3, 0, 0})}}, 0.1);
  EXPECT_THAT(twist.corners(), ::testing::SizeIs(2));
  EXPECT_NEAR(twist.length(), 2, 1e-14);
}

TEST(BlendedPolyline, RoundsEveryAngle) {
  for (double angle = 0.001; angle < 3.141; angle += 0.001) {
    const Curve curve =
        *Curve::polyline(std::vector<Pose>{at_point(-1, 0, 0), at_point(0, 0, 0),
                                           at_point(std::cos(angle), std::sin(angle), 0)},
                         0.5);
    const bool back = angle > 179.0 / 180 * std::acos(-1.0);
    ASSERT_EQ(curve.corners().size(), back ? 3U : 2U) << angle;
    const double s = 0.37 * curve.end();
    ASSERT_NEAR(curve.nearest(curve.at(s).p).distance, 0, 1e-12) << angle;
  }
}

TEST(BlendedPolyline, WithoutRadiusIsSharp) {
  Rng rng(4);
  const std::vector<Pose> points = random_poses(rng, 6);
  const Curve curve = *Curve::polyline(points, 0);
  EXPECT_THAT(curve.blends(), ::testing::IsEmpty());
  EXPECT_THAT(curve.corners(), ::testing::SizeIs(6));
}

TEST(BlendedPolyline, RefusesARadiusThatIsNone) {
  const std::vector<Pose> points{at_point(0, 0, 0), at_point(1, 0, 0), at_point(1, 1, 0)};
  for (const double blend :
       {-0.01, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const Result<Curve> curve = Curve::polyline(points, blend);
    ASSERT_FALSE(curve);
    EXPECT_THAT(curve.error().what, ::testing::HasSubstr("blend"));
  }
}

TEST(BlendedPolyline, TakesAHundredThousandPoints) {
  Rng rng(5);
  const std::vector<Pose> points = random_poses(rng, 100000);
  const Curve curve = *Curve::polyline(points, 0.1);
  EXPECT_EQ(curve.blends().size(), points.size() - 2);
  for (int i = 0; i < 10; ++i) {
    const double s = rng.uniform(0, curve.end());
    EXPECT_LT(curve.nearest(curve.at(s).p).distance, 1e-9);
  }
}

}  // namespace
}  // namespace mjarm
