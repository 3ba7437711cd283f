#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/path/poses_test.hpp"

namespace mjarm {
namespace {

using testing::at_point;
using testing::random_vec;
using Vec = Eigen::Vector3d;

Pose pose_within(Rng& rng, double size) {
  return {random_vec(rng, size), from_euler(random_vec(rng, 3))};
}

/// A line or an arc of any angle up to the whole circle, from `from`.
Curve random_leg(Rng& rng, const Pose& from, bool round, double size) {
  const Pose to = pose_within(rng, size);
  return round ? *Curve::arc(from, pose_within(rng, size), to) : *Curve::line(from, to);
}

std::vector<Curve> random_legs(Rng& rng, int n, double size = 1) {
  std::vector<Curve> legs;
  Pose from = pose_within(rng, size);
  for (int i = 0; i < n; ++i) {
    legs.push_back(random_leg(rng, from, rng.uniform() < 0.6, size));
    from = legs.back().at(legs.back().end());
  }
  return legs;
}

std::vector<double> random_blends(Rng& rng, std::size_t n) {
  std::vector<double> blends;
  for (std::size_t i = 0; i < n; ++i) blends.push_back(rng.uniform(0.01, 1));
  return blends;
}

/// What a curve does at `s`, by differences of second order that look to one side only: `h` > 0
/// forwards, `h` < 0 backwards.
struct Derivatives {
  Vec direction, curvature, rate;
};
Derivatives one_sided(const Curve& curve, double s, double h) {
  const Pose X0 = curve.at(s), X1 = curve.at(s + h), X2 = curve.at(s + 2 * h);
  const Vec p3 = curve.at(s + 3 * h).p;
  const auto turned = [&](const Pose& X) { return rotation_log(X0.R.transpose() * X.R); };
  return {(4 * X1.p - X2.p - 3 * X0.p) / (2 * h), (2 * X0.p - 5 * X1.p + 4 * X2.p - p3) / (h * h),
          (4 * turned(X1) - turned(X2)) / (2 * h)};
}

/// Angle between the directions in which a curve comes to `s` and leaves it.
double corner_angle(const Curve& curve, double s) {
  const Vec before = one_sided(curve, s, -1e-5).direction,
            after = one_sided(curve, s, 1e-5).direction;
  return std::atan2(before.cross(after).norm(), before.dot(after));
}

/// By how much the direction changes from `from` to `to`, all changes added up.
double total_turn(const Curve& curve, double from, double to, int n) {
  double sum = 0;
  Vec p = curve.at(from).p, last = Vec::Zero();
  for (int i = 1; i <= n; ++i) {
    const Vec next = curve.at(from + (to - from) * i / n).p, way = next - p;
    if (i > 1) sum += std::atan2(last.cross(way).norm(), last.dot(way));
    last = way;
    p = next;
  }
  return sum;
}

TEST(JoinedCurve, LeavesItsLegsOnlyNearTheCorners) {
  Rng rng(1);
  int bends = 0;
  for (int i = 0; i < 200; ++i) {
    const std::vector<Curve> legs = random_legs(rng, 2 + i % 4);
    const std::vector<double> blends = random_blends(rng, legs.size() - 1);
    const Curve sharp = *Curve::joined(legs, std::vector<double>(blends.size(), 0.0));
    const Curve curve = *Curve::joined(legs, blends);
    ASSERT_EQ(curve.blends().size(), blends.size());
    for (int k = 0; k <= 1000; ++k) {
      const Pose X = curve.at(curve.end() * k / 1000);
      if (sharp.nearest(X.p).distance < 1e-9) continue;
      ASSERT_TRUE(std::ranges::any_of(curve.blends(),
                                      [&](const CurveBlend& b) {
                                        return (X.p - legs[b.point].at(0).p).norm() <=
                                               b.radius * (1 + 1e-9);
                                      }))
          << i << " " << k;
    }
    // All of a leg farther from its corners than their radii, measured along it, is kept.
    for (std::size_t leg = 0; leg < legs.size(); ++leg) {
      const double from = leg == 0 ? 0 : curve.blends()[leg - 1].radius;
      const double to = legs[leg].end() - (leg < blends.size() ? curve.blends()[leg].radius : 0);
      ASSERT_LE(from, to + 1e-9);
      for (int k = 0; k <= 20; ++k) {
        const Vec p = legs[leg].at(from + (to - from) * k / 20).p;
        EXPECT_LT(curve.nearest(p).distance, 1e-9);
      }
    }
    for (const CurveBlend& b : curve.blends()) {
      EXPECT_LE(b.radius, blends[b.point - 1]);
      if (b.radius > 0) ++bends;
    }
    EXPECT_LT((curve.at(0).p - legs.front().at(0).p).norm(), 1e-12);
    EXPECT_LT((curve.at(curve.end()).p - legs.back().at(legs.back().end()).p).norm(), 1e-9);
  }
  EXPECT_GT(bends, 450);  // of 500
}

TEST(JoinedCurve, DirectionCurvatureAndRateOfTurnAreContinuous) {
  Rng rng(2);
  int checked = 0;
  for (int i = 0; i < 300; ++i) {
    const std::vector<Curve> legs = random_legs(rng, 2);
    const Curve curve = *Curve::joined(legs, random_blends(rng, 1));
    const double radius = curve.blends().at(0).radius;
    if (radius == 0) continue;  // turns back
    EXPECT_THAT(curve.corners(), ::testing::SizeIs(2));
    const double h = 1e-3 * std::min({radius, legs[0].end() - radius, legs[1].end() - radius});
    if (h < 1e-6) continue;  // a leg of which nothing is left
    ++checked;
    for (const double s : {legs[0].end() - radius, curve.end() - (legs[1].end() - radius)}) {
      const Derivatives before = one_sided(curve, s, -h), after = one_sided(curve, s, h);
      EXPECT_LT((before.direction - after.direction).norm(), 1e-4) << i;
      EXPECT_LT((before.curvature - after.curvature).norm() * radius, 5e-3) << i;
      EXPECT_LT((before.rate - after.rate).norm() * radius, 2e-3) << i;
    }
  }
  EXPECT_GT(checked, 200);
}

TEST(JoinedCurve, ChecksOfContinuityCanFail) {
  // Sharp: the direction jumps. A tangent arc behind a line is left as it is: the curvature jumps.
  const std::vector<Curve> corner{
      *Curve::line(at_point(0, 0, 0), at_point(1, 0, 0)),
      *Curve::arc(at_point(1, 0, 0), at_point(1.2, 0.2, 0), at_point(1, 0.4, 0))};
  const Curve smooth = *Curve::joined(corner, std::vector<double>{0.1});
  EXPECT_THAT(smooth.blends(), ::testing::IsEmpty());
  EXPECT_THAT(smooth.corners(), ::testing::SizeIs(2));
  EXPECT_THAT(smooth.breaks(), ::testing::ElementsAre(1));
  const Derivatives before = one_sided(smooth, 1, -1e-4), after = one_sided(smooth, 1, 1e-4);
  EXPECT_LT((before.direction - after.direction).norm(), 1e-6);
  EXPECT_NEAR((before.curvature - after.curvature).norm(), 5, 1e-3);
  const std::vector<Curve> sharp{
      corner[0], *Curve::line(at_point(1, 0, 0), {Vec(1, 1, 0), rotation_exp({0, 0, 0.5})})};
  const Curve broken = *Curve::joined(sharp, std::vector<double>{0.0});
  const Derivatives in = one_sided(broken, 1, -1e-4), out = one_sided(broken, 1, 1e-4);
  EXPECT_NEAR((in.direction - out.direction).norm(), std::sqrt(2), 1e-6);
  EXPECT_NEAR((in.rate - out.rate).norm(), 0.5, 1e-6);
}

TEST(JoinedCurve, BendsHaveNoLoops) {
  // All turning of the legs within the radius and of the corner is needed; a loop would add a turn.
  Rng rng(3);
  int checked = 0;
  for (int i = 0; i < 200; ++i) {
    const std::vector<Curve> legs = random_legs(rng, 2);
    const Curve curve = *Curve::joined(legs, random_blends(rng, 1));
    const Curve sharp = *Curve::joined(legs, std::vector<double>{0.0});
    const double radius = curve.blends().at(0).radius, corner = legs[0].end();
    if (radius == 0) continue;
    const double before = total_turn(legs[0], corner - radius, corner, 200);
    const double behind = total_turn(legs[1], 0, radius, 200);
    const double turn =
        total_turn(curve, corner - radius, curve.end() - (legs[1].end() - radius), 1000);
    EXPECT_LT(turn, before + corner_angle(sharp, corner) + behind + 0.12) << i;
    ++checked;
  }
  EXPECT_GT(checked, 190);
}

TEST(JoinedCurve, BetweenLinesIsTheQuarticOfPolylines) {
  Rng rng(4);
  for (int i = 0; i < 100; ++i) {
    const std::vector<Pose> points{pose_within(rng, 1), pose_within(rng, 1), pose_within(rng, 1),
                                   pose_within(rng, 1)};
    const std::vector<double> blends = random_blends(rng, 2);
    std::vector<Curve> legs;
    for (std::size_t k = 0; k < 3; ++k) legs.push_back(*Curve::line(points[k], points[k + 1]));
    const Curve joined = *Curve::joined(legs, blends), line = *Curve::polyline(points, blends);
    ASSERT_NEAR(joined.end(), line.end(), 1e-14);
    for (int k = 0; k <= 100; ++k) {
      const Pose X = joined.at(joined.end() * k / 100), Y = line.at(joined.end() * k / 100);
      ASSERT_LT((X.p - Y.p).norm(), 1e-12);
      ASSERT_LT(angle_between(X.R, Y.R), 1e-12);
    }
    for (const CurveBlend& b : joined.blends()) {
      if (b.radius == 0) continue;
      const Vec corner = points[b.point].p;
      const Vec t0 = (corner - points[b.point - 1].p).normalized(),
                t1 = (points[b.point + 1].p - corner).normalized();
      const auto way = [&](double u) { return -b.radius * std::pow(1 - u, 3) * (1 + u); };
      for (double u = 0; u <= 1; u += 0.05) {
        const Vec p = corner + way(u) * t0 - way(1 - u) * t1;
        ASSERT_LT(joined.nearest(p).distance, 1e-12);
      }
    }
  }
}

TEST(JoinedCurve, SharesLegsThatAreTooShort) {
  // Half a circle of radius 0.1 between two lines.
  const Pose a = at_point(0, -1, 0), b = at_point(0.1, 0, 0), c = at_point(-0.1, 0, 0),
             d = at_point(0, -1, 0);
  const std::vector<Curve> legs{*Curve::line(a, b), *Curve::arc(b, at_point(0, 0.1, 0), c),
                                *Curve::line(c, d)};
  const double half = 0.1 * std::acos(-1.0);
  const auto radii = [&](double first, double second) {
    const Curve curve = *Curve::joined(legs, std::vector<double>{first, second});
    return std::pair(curve.blends().at(0).radius, curve.blends().at(1).radius);
  };
  EXPECT_THAT(radii(0.05, 0.15), ::testing::Pair(0.05, 0.15));
  // A corner takes a quarter of the circle at most.
  EXPECT_THAT(radii(0.05, 0.5), ::testing::Pair(0.05, ::testing::DoubleNear(0.5 * half, 1e-12)));
  const std::vector<Curve> flat{legs[0], *Curve::arc(b, at_point(0, 0.01, 0), c), legs[2]};
  const double length = flat[1].end();
  const Curve curve = *Curve::joined(flat, std::vector<double>{0.1, 0.2});
  EXPECT_NEAR(curve.blends()[0].radius, length / 3, 1e-12);
  EXPECT_NEAR(curve.blends()[1].radius, length * 2 / 3, 1e-12);
  EXPECT_THAT(curve.corners(), ::testing::SizeIs(2));  // nothing is left of the arc
}

TEST(JoinedCurve, TellsWhereItsLegsMeet) {
  Rng rng(5);
  for (int i = 0; i < 50; ++i) {
    const std::vector<Curve> legs = random_legs(rng, 4, 0.5);
    const Curve curve = *Curve::joined(legs, random_blends(rng, 3));
    ASSERT_EQ(curve.breaks().size(), 3U);
    EXPECT_TRUE(std::ranges::is_sorted(curve.breaks()));
    for (const CurveBlend& b : curve.blends()) {
      const Pose given = legs[b.point].at(0), X = curve.at(curve.breaks()[b.point - 1]);
      EXPECT_NEAR((X.p - given.p).norm(), b.distance, 1e-12);
      EXPECT_NEAR(angle_between(X.R, given.R), b.turn, 1e-9);
    }
  }
  // A square that is drawn twice: the nearest point to a corner would be that of the first lap.
  const Pose a = at_point(0, 0, 0), b = at_point(1, 0, 0), c = at_point(1, 1, 0),
             d = at_point(0, 1, 0);
  const Curve laps = *Curve::polyline(std::vector<Pose>{a, b, c, d, a, b, c, d, a}, 0.1);
  ASSERT_EQ(laps.breaks().size(), 7U);
  for (std::size_t i = 1; i < 7; ++i) {
    EXPECT_NEAR(laps.breaks()[i] - laps.breaks()[i - 1], laps.breaks()[3] - laps.breaks()[2], 1e-9);
  }
}

TEST(JoinedCurve, KeepsCornersThatTurnBack) {
  const Pose a = at_point(0, 0, 0), b = at_point(1, 0, 0);
  const std::vector<Curve> legs{*Curve::line(a, b),
                                *Curve::arc(b, at_point(0.8, 0.2, 0), at_point(0.6, 0.4001, 0)),
                                *Curve::line(at_point(0.6, 0.4001, 0), b)};
  ASSERT_GT(std::cos(corner_angle(*Curve::joined(legs, std::vector<double>{0.0, 0.0}), 1)), -1);
  // Back along the tangent of an arc: a cusp.
  const Curve arc = *Curve::arc(at_point(0, 0, 0), at_point(0.2, 0.2, 0), at_point(0, 0.4, 0));
  const std::vector<Curve> cusp{arc, *Curve::line(at_point(0, 0.4, 0), at_point(1, 0.4, 0))};
  const Curve curve = *Curve::joined(cusp, std::vector<double>{0.1});
  EXPECT_EQ(curve.blends().at(0).radius, 0);
  EXPECT_THAT(curve.corners(), ::testing::SizeIs(3));
}

TEST(JoinedCurve, OneLegIsItself) {
  Rng rng(6);
  const Curve leg = random_leg(rng, pose_within(rng, 1), true, 1);
  const Curve curve = *Curve::joined(std::vector<Curve>{leg}, std::vector<double>{});
  EXPECT_EQ(curve.end(), leg.end());
  EXPECT_EQ(curve.at(0.3).p, leg.at(0.3).p);
  EXPECT_THAT(curve.breaks(), ::testing::IsEmpty());
}

TEST(JoinedCurve, SplinesAreJoinedAsTheyAreAndTheirCornersStaySharp) {
  const Pose a = at_point(0, 0, 0), b = at_point(1, 0, 0), c = at_point(1, 1, 0),
             d = at_point(0, 1.5, 0.2), e = at_point(0, 2, 0);
  const Curve line = *Curve::line(a, b), last = *Curve::line(d, e);
  const Curve spline = *Curve::spline(std::vector<Pose>{b, c, d});
  const Curve curve =
      *Curve::joined(std::vector<Curve>{line, spline, last}, std::vector<double>{0.1, 0.1});
  EXPECT_NEAR(curve.length(), line.length() + spline.length() + last.length(), 1e-12);
  ASSERT_EQ(curve.corners().size(), 4U);
  EXPECT_NEAR(curve.corners()[1], 1, 1e-12);
  EXPECT_NEAR(curve.corners()[2], 1 + spline.length(), 1e-12);
  for (int i = 0; i <= 20; ++i) {
    const double s = spline.end() * i / 20;
    EXPECT_LT((curve.at(1 + s).p - spline.at(s).p).norm(), 1e-12);
  }
}

TEST(JoinedCurve, SaysWhatCannotBeJoined) {
  const Pose a = at_point(0, 0, 0), b = at_point(1, 0, 0), c = at_point(1, 1, 0);
  const Curve first = *Curve::line(a, b), second = *Curve::line(b, c);
  const auto error = [](std::vector<Curve> legs, std::vector<double> blends) {
    const Result<Curve> curve = Curve::joined(legs, blends);
    return curve ? std::string("none") : curve.error().what;
  };
  EXPECT_THAT(error({}, {}), ::testing::HasSubstr("at least one leg"));
  EXPECT_THAT(error({first, second}, {}), ::testing::HasSubstr("0 blends for 3 points"));
  EXPECT_THAT(error({first, second}, {-1}), ::testing::HasSubstr("-1"));
  EXPECT_THAT(error({first, second}, {std::numeric_limits<double>::quiet_NaN()}),
              ::testing::HasSubstr("nan"));
  EXPECT_THAT(error({second, first}, {0.1}), ::testing::HasSubstr("leg 1 (from 0)"));
  const Curve turned = *Curve::line({b.p, rotation_exp({0, 0, 0.1})}, c);
  EXPECT_THAT(error({first, turned}, {0.1}), ::testing::HasSubstr("where leg 0 ends"));
  const Curve broken = *Curve::polyline(std::vector<Pose>{b, c, a});
  EXPECT_THAT(error({first, broken}, {0.1}), ::testing::HasSubstr("only straight lines"));
  const Curve oval = *Curve::ellipse({b.p, 0.2, 0.1, Vec::UnitZ(), Eigen::Matrix3d::Identity()});
  EXPECT_THAT(error({first, oval}, {0.1}), ::testing::HasSubstr("only straight lines"));
  EXPECT_EQ(error({first, second}, {0.1}), "none");
}

}  // namespace
}  // namespace mjarm
