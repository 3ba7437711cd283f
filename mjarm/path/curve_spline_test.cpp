#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/path/curve.hpp"

namespace mjarm {
namespace {

using Vec = Eigen::Vector3d;

/// Poses along a wandering way: neighbours are some steps apart, the tool turns by up to 2.9 rad.
std::vector<Pose> wander(Rng& rng, int n, double scale) {
  std::vector<Pose> poses;
  Pose X;
  for (int i = 0; i < n; ++i) {
    const auto part = [&](double size) { return rng.uniform(-size, size); };
    X.p += scale * Vec(rng.uniform(0.2, 1), part(0.7), part(0.7));
    X.R = X.R * rotation_exp(rng.uniform(0, 2.9) * Vec(part(1), part(1), part(1)).normalized());
    poses.push_back(X);
  }
  return poses;
}

TEST(Spline, GoesThroughEveryPoseInOrder) {
  Rng rng(1);
  for (int i = 0; i < 200; ++i) {
    const double scale = std::pow(10, rng.uniform(-5, 4));
    const std::vector<Pose> poses = wander(rng, 2 + i % 12, scale);
    const Curve curve = Curve::spline(poses).value();
    EXPECT_THAT(curve.corners(), ::testing::SizeIs(2));
    double last = -1;
    for (const Pose& X : poses) {
      const Curve::Nearest nearest = curve.nearest(X.p);
      EXPECT_LT(nearest.distance, 1e-12 * scale);
      EXPECT_LT(angle_between(curve.at(nearest.s).R, X.R), 1e-9);
      EXPECT_GT(nearest.s, last);
      last = nearest.s;
    }
    EXPECT_EQ((curve.at(0).p - poses.front().p).norm(), 0);
    EXPECT_LT((curve.at(curve.end()).p - poses.back().p).norm(), 1e-14 * scale * (2 + i % 12));
  }
}

TEST(Spline, HasContinuousCurvatureAndRateOfTurn) {
  Rng rng(2);
  for (int i = 0; i < 200; ++i) {
    const std::vector<Pose> poses = wander(rng, 6, 1);
    const Curve curve = Curve::spline(poses).value();
    for (std::size_t k = 1; k + 1 < poses.size(); ++k) {
      const double s = curve.nearest(poses[k].p).s;
      // One-sided differences, extrapolated to the knot itself.
      const auto one_sided = [&](double h) -> Vec {
        const auto second = [&](double x) -> Vec {
          const double a = std::abs(h);
          return (curve.at(x - a).p - 2 * curve.at(x).p + curve.at(x + a).p) / (a * a);
        };
        return 2 * second(s + 2 * h) - second(s + 4 * h);
      };
      const Vec before = one_sided(-1e-4), after = one_sided(1e-4);
      EXPECT_LT((before - after).norm(), 1e-3 * (1 + after.norm())) << i << " " << k;
      const auto rate = [&](double h) -> Vec {
        return rotation_log(curve.at(s).R.transpose() * curve.at(s + h).R) / h;
      };
      EXPECT_LT((2 * rate(1e-5) - rate(2e-5) - 2 * rate(-1e-5) + rate(-2e-5)).norm(),
                1e-4 * (1 + rate(1e-5).norm()));
    }
  }
}

TEST(Spline, IsAStraightLineThroughPosesOfOne) {
  std::vector<Pose> poses;
  for (const double x : {0.0, 0.1, 0.5, 0.7, 1.0}) {
    poses.push_back({Vec(x, 2 * x, -x), from_euler({0, 0, 2 * x})});
  }
  const Curve curve = *Curve::spline(poses), line = *Curve::line(poses.front(), poses.back());
  EXPECT_NEAR(curve.length(), line.length(), 1e-14);
  for (double s = 0; s < line.end(); s += 0.01) {
    EXPECT_LT((curve.at(s).p - line.at(s).p).norm(), 1e-13);
    EXPECT_LT(angle_between(curve.at(s).R, line.at(s).R), 1e-12);
  }
}

TEST(Spline, NearsASmoothCurveByTheFourthPowerOfTheSpacing) {
  const auto error = [](int n) {
    std::vector<Pose> poses;
    for (int i = 0; i <= n; ++i) {
      const double t = 3.0 * i / n;
      poses.push_back({Vec(std::cos(t), std::sin(t), 0.3 * t), from_euler({0, 0, std::sin(t)})});
    }
    const Curve curve = *Curve::spline(poses);
    double largest = 0;
    // Away from the ends, where the natural spline bends less than the helix.
    for (double t = 1; t < 2; t += 0.001) {
      const Vec p(std::cos(t), std::sin(t), 0.3 * t);
      const Curve::Nearest nearest = curve.nearest(p);
      largest = std::max({largest, nearest.distance,
                          angle_between(curve.at(nearest.s).R, from_euler({0, 0, std::sin(t)}))});
    }
    return largest;
  };
  const double coarse = error(30), fine = error(60);
  EXPECT_LT(coarse, 1e-5);
  EXPECT_LT(fine, coarse / 12);
}

TEST(Spline, RefusesWhatHasNoSmoothCurve) {
  using ::testing::HasSubstr;
  const auto complaint = [](const std::vector<Pose>& poses) {
    const Result<Curve> curve = Curve::spline(poses);
    return curve ? std::string("none") : curve.error().what;
  };
  const auto at = [](double x, double y = 0) {
    return Pose{Vec(x, y, 0), Eigen::Matrix3d::Identity()};
  };
  EXPECT_THAT(complaint({}), HasSubstr("at least 2"));
  EXPECT_THAT(complaint({at(0)}), HasSubstr("at least 2"));
  EXPECT_THAT(complaint({at(0), at(1), at(1), at(2)}), HasSubstr("1 and 2"));
  EXPECT_THAT(complaint({at(0), {Vec::Zero(), from_euler({1, 0, 0})}}), HasSubstr("same place"));
  EXPECT_THAT(complaint({at(0), at(1), at(0.5)}), HasSubstr("turn back between poses 0 and 1"));
  EXPECT_THAT(complaint({at(0), at(1), at(0, std::numeric_limits<double>::quiet_NaN())}),
              HasSubstr("pose 2"));
  EXPECT_THAT(complaint({at(0), at(1e7)}), HasSubstr("pose 1"));
  EXPECT_EQ(complaint({at(0), at(1), at(0.5, 0.1)}), "none");
}

TEST(Spline, KeepsTheCornersItIsAskedToKeep) {
  const auto at = [](double x, double y) {
    return Pose{Vec(x, y, 0), Eigen::Matrix3d::Identity()};
  };
  // Bends by about 27, 90 and 27 degrees.
  const std::vector<Pose> poses = {at(0, 0), at(2, 0), at(4, 1), at(3, 3), at(3, 5)};
  const Curve all = *Curve::spline(poses), kept = *Curve::spline(poses, 1.0);
  EXPECT_EQ(all.corners().size(), 2U);
  ASSERT_EQ(kept.corners().size(), 3U);
  EXPECT_LT((kept.at(kept.corners()[1]).p - poses[2].p).norm(), 1e-12);
  const Curve first = *Curve::spline(std::span(poses).first(3)),
              second = *Curve::spline(std::span(poses).last(3));
  for (int i = 0; i <= 10; ++i) {
    const double s = i / 10.0;
    EXPECT_LT((kept.at(s * first.end()).p - first.at(s * first.end()).p).norm(), 1e-12);
    EXPECT_LT((kept.at(first.end() + s * second.end()).p - second.at(s * second.end()).p).norm(),
              1e-12);
  }
  EXPECT_EQ(Curve::spline(poses, 0.1)->corners().size(), 5U);
}

TEST(Spline, TakesAHundredThousandPoses) {
  Rng rng(3);
  const std::vector<Pose> poses = wander(rng, 100000, 0.1);
  const Curve curve = Curve::spline(poses).value();
  for (int i = 0; i < 10; ++i) {
    EXPECT_LT(curve.nearest(poses[static_cast<std::size_t>(i) * 9999].p).distance, 1e-9);
  }
}

}  // namespace
}  // namespace mjarm
