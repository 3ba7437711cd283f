#include "mjarm/path/curve.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/path/poses_test.hpp"
#include "tests/support/constants.hpp"
#include "tests/support/rounds.hpp"

namespace mjarm {
namespace {

using support::kNaN;
using support::kPi;
using testing::at_point;
using testing::random_vec;
using Vec = Eigen::Vector3d;

Pose random_pose(Rng& rng) { return {random_vec(rng, 1), from_euler(random_vec(rng, 3))}; }

/// Length of a polyline of `n` chords through the curve.
double chord_length(const Curve& curve, double s0, double s1, int n) {
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    sum += (curve.at(s0 + (s1 - s0) * (i + 1) / n).p - curve.at(s0 + (s1 - s0) * i / n).p).norm();
  }
  return sum;
}

std::vector<Curve> random_curves(Rng& rng) {
  std::vector<Curve> curves;
  curves.push_back(*Curve::line(random_pose(rng), random_pose(rng)));
  curves.push_back(*Curve::arc(random_pose(rng), random_pose(rng), random_pose(rng)));
  curves.push_back(*Curve::polyline(
      std::vector<Pose>{random_pose(rng), random_pose(rng), random_pose(rng), random_pose(rng)}));
  curves.push_back(*Curve::circle(random_pose(rng), random_pose(rng), random_pose(rng)));
  curves.push_back(*Curve::polyline(
      std::vector<Pose>{random_pose(rng), random_pose(rng), random_pose(rng), random_pose(rng)},
      rng.uniform(0.01, 1)));
  curves.push_back(*Curve::spline(
      std::vector<Pose>{random_pose(rng), random_pose(rng), random_pose(rng), random_pose(rng)}));
  curves.push_back(*Curve::ellipse({random_vec(rng, 1), rng.uniform(0.01, 1), rng.uniform(0.01, 1),
                                    random_vec(rng, 1), from_euler(random_vec(rng, 3))}));
  return curves;
}

TEST(Curve, IsWalkedByItsOwnLength) {
  Rng rng(1);
  for (int i = 0; i < testing::rounds(20, 1000); ++i) {
    for (const Curve& curve : random_curves(rng)) {
      ASSERT_DOUBLE_EQ(curve.length(), curve.end());
      double s = 0;
      for (int k = 0; k < 5; ++k) {
        const double next = rng.uniform(s, curve.end());
        const double chords = chord_length(curve, s, next, 400);
        EXPECT_NEAR(chords, next - s, 0.01 * (next - s) + 1e-12);  // chords cut corners
        EXPECT_LE(chords, next - s + 1e-12);
        s = next;
      }
    }
  }
}

TEST(Curve, MovesAtConstantSpeedBetweenCorners) {
  Rng rng(2);
  constexpr double kStep = 1e-5;
  for (int i = 0; i < 100; ++i) {
    const Curve ellipse = *Curve::ellipse(
        {random_vec(rng, 1), rng.uniform(0.05, 1), rng.uniform(0.05, 1), random_vec(rng, 1)});
    const double s = rng.uniform(kStep, ellipse.end() - kStep);
    const double speed = (ellipse.at(s + kStep).p - ellipse.at(s - kStep).p).norm() / (2 * kStep);
    EXPECT_NEAR(speed, 1, 1e-6);
  }
}

TEST(Curve, ReachesItsGivenPoses) {
  Rng rng(3);
  for (int i = 0; i < 200; ++i) {
    const Pose from = random_pose(rng), via = random_pose(rng), to = random_pose(rng);
    const auto expect_pose = [](const Pose& X, const Pose& expected) {
      EXPECT_LT((X.p - expected.p).norm(), 1e-12);
      EXPECT_LT(angle_between(X.R, expected.R), 1e-12);
    };
    for (const Curve& curve : {*Curve::line(from, to), *Curve::arc(from, via, to),
                               *Curve::polyline(std::vector<Pose>{from, via, to})}) {
      expect_pose(curve.at(0), from);
      expect_pose(curve.at(curve.end()), to);
      expect_pose(curve.at(-1), from);
      expect_pose(curve.at(curve.end() + 1), to);
    }
    const Curve polyline = *Curve::polyline(std::vector<Pose>{from, via, to});
    expect_pose(polyline.at(polyline.corners().at(1)), via);
    const Curve arc = *Curve::arc(from, via, to);
    expect_pose(arc.at(arc.nearest(via.p).s), via);
    const Pose middle = Curve::line(from, to)->at(0.25 * (to.p - from.p).norm());
    expect_pose(middle, interpolate(from, to, 0.25));
  }
}

TEST(Curve, ArcKeepsItsDistanceFromTheCentre) {
  Rng rng(4);
  for (int i = 0; i < 200; ++i) {
    const Vec center = random_vec(rng, 1);
    const EllipseAxes axes = ellipse_axes(random_vec(rng, 1));
    const double r = rng.uniform(0.01, 2), t1 = rng.uniform(0.1, 3),
                 t2 = rng.uniform(t1 + 0.1, 6.1);
    const auto point = [&](double t) {
      return Pose{center + r * (std::cos(t) * axes.u + std::sin(t) * axes.v),
                  Eigen::Matrix3d::Identity()};
    };
    const Curve arc = *Curve::arc(point(0), point(t1), point(t2));
    EXPECT_NEAR(arc.length(), r * t2, 1e-9);
    for (double s = 0; s < arc.end(); s += arc.end() / 17) {
      EXPECT_LT((arc.at(s).p - point(s / r).p).norm(), 1e-9);
    }
  }
}

TEST(Curve, ArcTurnsWithoutJumpsOfItsRate) {
  Rng rng(5);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 100; ++i) {
    const Pose from = random_pose(rng), via = random_pose(rng), to = random_pose(rng);
    const Curve arc = *Curve::arc(from, via, to);
    const double s = arc.nearest(via.p).s;
    const Vec before = rotation_log(arc.at(s - kStep).R.transpose() * arc.at(s).R) / kStep;
    const Vec after = rotation_log(arc.at(s).R.transpose() * arc.at(s + kStep).R) / kStep;
    EXPECT_LT((before - after).norm(), 1e-3 * (1 + before.norm()));
    EXPECT_NEAR(arc.turn(), angle_between(from.R, via.R) + angle_between(via.R, to.R), 1e-9);
    EXPECT_THAT(arc.corners(), ::testing::SizeIs(2));
  }
}

TEST(Curve, CircleIsAWholeRoundTrip) {
  Rng rng(9);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 100; ++i) {
    const Pose poses[] = {random_pose(rng), random_pose(rng), random_pose(rng)};
    const Curve circle = *Curve::circle(poses[0], poses[1], poses[2]);
    const Curve arc = *Curve::arc(poses[0], poses[1], poses[2]);
    EXPECT_TRUE(circle.closed());
    EXPECT_THAT(circle.corners(), ::testing::SizeIs(2));
    // The centre lies opposite to every point, half a lap away.
    const Vec center = 0.5 * (circle.at(0).p + circle.at(0.5 * circle.end()).p);
    const double radius = (poses[0].p - center).norm();
    EXPECT_NEAR(circle.length(), 2 * kPi * radius, 1e-9 * radius);
    double last = -1;
    for (const Pose& X : poses) {
      const Curve::Nearest nearest = circle.nearest(X.p);
      EXPECT_LT(angle_between(circle.at(nearest.s).R, X.R), 1e-6);
      EXPECT_LT(nearest.distance, 1e-9);
      EXPECT_NEAR((X.p - center).norm(), radius, 1e-9 * radius);
      EXPECT_GT(nearest.s, last);
      last = nearest.s;
    }
    EXPECT_LT((circle.at(0.3 * arc.end()).p - arc.at(0.3 * arc.end()).p).norm(), 1e-12);
    const auto rate = [&](double s) -> Vec {
      return rotation_log(circle.at(s).R.transpose() * circle.at(s + kStep).R) / kStep;
    };
    EXPECT_LT((rate(0) - rate(circle.end() - kStep)).norm(), 1e-3 * (1 + rate(0).norm()));
  }
  const Curve round = *Curve::circle(Vec(1, 2, 3), Vec::UnitZ(), 0.5, from_euler({1, 0, 0}));
  EXPECT_LT((round.at(0).p - Vec(1.5, 2, 3)).norm(), 1e-15);
  EXPECT_LT((round.at(0.25 * round.end()).p - Vec(1, 2.5, 3)).norm(), 1e-12);
  EXPECT_LT(angle_between(round.at(1).R, from_euler({1, 0, 0})), 1e-12);
}

TEST(Curve, StationsAreNearEachOther) {
  Rng rng(6);
  for (int i = 0; i < 50; ++i) {
    for (const Curve& curve : random_curves(rng)) {
      const double step = rng.uniform(0.003, 0.2), angle = rng.uniform(0.01, 0.3);
      const std::vector<double> s = curve.stations(step, angle);
      EXPECT_EQ(s.front(), 0);
      EXPECT_EQ(s.back(), curve.end());
      for (const double corner : curve.corners()) EXPECT_THAT(s, ::testing::Contains(corner));
      for (std::size_t k = 1; k < s.size(); ++k) {
        ASSERT_GT(s[k], s[k - 1]);
        ASSERT_LE(s[k] - s[k - 1], step * (1 + 1e-9));
        ASSERT_LE(angle_between(curve.at(s[k - 1]).R, curve.at(s[k]).R), angle * (1 + 1e-9));
      }
    }
  }
}

TEST(Curve, NearestBeatsEveryOtherPoint) {
  Rng rng(7);
  for (int i = 0; i < 200; ++i) {
    for (const Curve& curve : random_curves(rng)) {
      // Far points, points beside the curve, and points within ellipses, where several feet
      // compete.
      const double s0 = rng.uniform(0, curve.end());
      const Vec p = i % 2 == 0 ? random_vec(rng, 2) : Vec(curve.at(s0).p + random_vec(rng, 0.02));
      const Curve::Nearest nearest = curve.nearest(p);
      EXPECT_NEAR((curve.at(nearest.s).p - p).norm(), nearest.distance, 1e-12);
      for (int k = 0; k <= 300; ++k) {
        ASSERT_LE(nearest.distance, (curve.at(curve.end() * k / 300).p - p).norm() + 1e-12);
      }
    }
  }
}

TEST(Curve, NearestWithinThinEllipsesIsGlobal) {
  Rng rng(8);
  for (int i = 0; i < 500; ++i) {
    const double a = rng.uniform(0.1, 1), b = a * rng.uniform(0.01, 1.2);
    const Curve curve = *Curve::ellipse({.a = a, .b = b});
    // On the axes too, where the nearest point is not unique.
    const Vec p(i % 5 == 0 ? 0 : rng.uniform(-a, a), i % 7 == 0 ? 0 : rng.uniform(-b, b), 0);
    const double distance = curve.nearest(p).distance;
    double best = 1e9;
    for (int k = 0; k < 3000; ++k) {
      const double t = 2 * kPi * k / 3000;
      best = std::min(best, (Vec(a * std::cos(t), b * std::sin(t), 0) - p).norm());
    }
    EXPECT_LE(distance, best + 1e-12);
    EXPECT_GE(distance, best - 2e-3 * a);
  }
}

TEST(Curve, CornersAreWhereTheDirectionBreaks) {
  const Curve square =
      *Curve::polyline(std::vector<Pose>{at_point(0, 0, 0), at_point(0.5, 0, 0), at_point(1, 0, 0),
                                         at_point(1, 1, 0), at_point(0, 1, 0), at_point(0, 0, 0)});
  EXPECT_THAT(square.corners(), ::testing::Pointwise(::testing::DoubleEq(), {0., 1., 2., 3., 4.}));
  EXPECT_TRUE(square.closed());
  EXPECT_TRUE(Curve::ellipse({})->closed());
  EXPECT_FALSE(Curve::line(at_point(0, 0, 0), at_point(1, 0, 0))->closed());
  // The same line, but the tool begins to turn half way.
  const Pose turned{Vec(1, 0, 0), from_euler({0.3, 0, 0})};
  EXPECT_THAT(
      Curve::polyline(std::vector<Pose>{at_point(0, 0, 0), at_point(0.5, 0, 0), turned})->corners(),
      ::testing::SizeIs(3));
}

TEST(Curve, TurnsOnTheSpotCountTheirAngle) {
  const Pose turned{Vec(1, 0, 0), from_euler({0, 0, 0.5})};
  const Curve spot = *Curve::line(at_point(1, 0, 0), turned);
  EXPECT_EQ(spot.length(), 0);
  EXPECT_NEAR(spot.end(), 0.5, 1e-12);
  EXPECT_NEAR(spot.turn(), 0.5, 1e-12);
  EXPECT_NEAR(angle_between(spot.at(0.2).R, Eigen::Matrix3d::Identity()), 0.2, 1e-12);
  EXPECT_EQ(spot.stations(0.001, 0.1).size(), 6U);
  const Curve both =
      *Curve::polyline(std::vector<Pose>{at_point(0, 0, 0), at_point(1, 0, 0), turned});
  EXPECT_THAT(both.corners(), ::testing::Pointwise(::testing::DoubleNear(1e-12), {0., 1., 1.5}));
  EXPECT_NEAR(both.length(), 1, 1e-12);
}

std::string complaint(const Result<Curve>& curve) { return curve ? "none" : curve.error().what; }

TEST(Curve, RefusesWhatIsNoCurve) {
  using ::testing::HasSubstr;
  const Pose zero = at_point(0, 0, 0), one = at_point(1, 0, 0), two = at_point(2, 0, 0);
  EXPECT_THAT(complaint(Curve::line(zero, zero)), HasSubstr("0 and 1"));
  EXPECT_THAT(complaint(Curve::line(zero, at_point(kNaN, 0, 0))), HasSubstr("pose 1"));
  EXPECT_THAT(complaint(Curve::line({Vec::Zero(), 2 * Eigen::Matrix3d::Identity()}, one)),
              HasSubstr("pose 0"));
  EXPECT_THAT(complaint(Curve::line(zero, at_point(1e308, 0, 0))), HasSubstr("pose 1"));
  EXPECT_THAT(complaint(Curve::polyline({})), HasSubstr("at least 2"));
  EXPECT_THAT(complaint(Curve::polyline(std::vector<Pose>{zero})), HasSubstr("1"));
  EXPECT_THAT(complaint(Curve::polyline(std::vector<Pose>{zero, one, one, two})),
              HasSubstr("1 and 2"));
  EXPECT_THAT(complaint(Curve::arc(zero, one, two)), HasSubstr("one line"));
  EXPECT_THAT(complaint(Curve::arc(zero, two, one)), HasSubstr("one line"));
  EXPECT_THAT(complaint(Curve::arc(zero, at_point(1, 1, 0), zero)), HasSubstr("0 and 2"));
  EXPECT_THAT(complaint(Curve::arc(zero, zero, one)), HasSubstr("0 and 1"));
  EXPECT_THAT(complaint(Curve::circle(zero, one, two)), HasSubstr("one line"));
  EXPECT_THAT(complaint(Curve::circle(zero, at_point(0, kNaN, 0), two)), HasSubstr("pose 1"));
  const Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  EXPECT_THAT(complaint(Curve::circle(zero.p, one.p, 0, R)), HasSubstr("radius is 0"));
  EXPECT_THAT(complaint(Curve::circle(zero.p, one.p, kNaN, R)), HasSubstr("radius is nan"));
  EXPECT_THAT(complaint(Curve::circle(zero.p, zero.p, 1, R)), HasSubstr("normal"));
  EXPECT_THAT(complaint(Curve::ellipse({.a = 1e300})), HasSubstr("semi-axis a"));
  EXPECT_THAT(complaint(Curve::ellipse({.a = 0})), HasSubstr("semi-axis a is 0"));
  EXPECT_THAT(complaint(Curve::ellipse({.b = -1})), HasSubstr("semi-axis b is -1"));
  EXPECT_THAT(complaint(Curve::ellipse({.a = kNaN})), HasSubstr("semi-axis a"));
  EXPECT_THAT(complaint(Curve::ellipse({.normal = Vec::Zero()})), HasSubstr("normal"));
  EXPECT_THAT(complaint(Curve::ellipse({.center = Vec(0, kNaN, 0)})), HasSubstr("centre"));
}

}  // namespace
}  // namespace mjarm
