#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mjarm/core/rng.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"
#include "mjarm/trajectory/limits_test.hpp"
#include "mjarm/trajectory/path_timing.hpp"
#include "mjarm/trajectory/reference_internal.hpp"

namespace mjarm {
namespace {

using testing::limits_of;
using testing::plain_limits;
using testing::timed;

/// A smooth closed way of four joints, with noise of the size given.
std::vector<JointVec> dense_path(int count, double noise) {
  Rng rng(41);
  std::vector<JointVec> points;
  for (int i = 0; i < count; ++i) {
    const double x = 2 * std::numbers::pi * i / (count - 1);
    JointVec q(4);
    q << std::cos(x), std::sin(2 * x), 0.5 * std::sin(3 * x + 1), 0.3 * x;
    for (double& value : q) value += noise * rng.uniform(-1, 1);
    points.push_back(q);
  }
  return points;
}

/// Limits kept by samples of `motion`, and every waypoint met where some piece of it starts.
void expect_sound(const Trajectory& motion, const std::vector<JointVec>& points,
                  const JointLimits& limits) {
  const LimitUse use =
      check_limits(motion, limits, motion.duration() / (5.1 * static_cast<double>(points.size())));
  EXPECT_LE(use.worst(), 1 + 1e-6);
  EXPECT_LE(use.jerk.maxCoeff(), 1 + 1e-3);  // by differences of a over tiny times
  std::size_t met = 0;
  for (std::size_t i = 0; i < motion.pieces(); ++i) {
    if (motion.piece(i).c.col(0) == points[met]) ++met;
  }
  EXPECT_EQ(met, points.size() - 1);
  EXPECT_EQ(motion.at(motion.duration()).q, points.back());
}

TEST(DensePaths, TakeAsLongAsTheSamePathWithFewerWaypoints) {
  const int count = testing::rounds(20000, 100000);
  const JointLimits limits = plain_limits(4);
  const std::vector<JointVec> points = dense_path(count, 0);
  const Trajectory dense = timed(points, limits, true);
  expect_sound(dense, points, limits);
  const double sparse = timed(dense_path(400, 0), limits, true).duration();
  EXPECT_LE(dense.duration(), 1.01 * sparse);
  EXPECT_GE(dense.duration(), 0.99 * timed(points, limits, false).duration());
}

TEST(DensePaths, WithNoiseKeepTheirLimitsAndTheirWaypoints) {
  constexpr double kOneCellAPiece = 13.470;  // [s] that a time law with a cell a piece takes
  const JointLimits limits = plain_limits(4);
  const std::vector<JointVec> points = dense_path(12000, 1e-8);
  const Trajectory motion = timed(points, limits, true);
  expect_sound(motion, points, limits);
  EXPECT_LE(motion.duration(), 1.05 * kOneCellAPiece);
}

TEST(DensePaths, KeepTorquesToo) {
  JointLimits limits = plain_limits(4);
  limits.torque = JointVec::Constant(4, 8);
  const InverseDynamics dynamics = [](const JointVec& q, const JointVec& v, const JointVec& a) {
    return JointVec(2 * a + v + 2 * q.array().cos().matrix());
  };
  const std::vector<JointVec> points = dense_path(12000, 0);
  const auto motion = time_waypoint_path(points, limits, {.dynamics = dynamics});
  ASSERT_TRUE(motion.has_value()) << motion.error().what;
  expect_sound(*motion, points, limits);
  EXPECT_LE(check_torque(*motion, dynamics, limits.torque, motion->duration() / 5e4).maxCoeff(),
            1.001);
  const auto sparse = time_waypoint_path(dense_path(400, 0), limits, {.dynamics = dynamics});
  ASSERT_TRUE(sparse.has_value());
  EXPECT_LE(motion->duration(), 1.01 * sparse->duration());
}

/// A profile along `spline` with what the reference is made from it.
struct Smoothed {
  explicit Smoothed(const std::vector<JointVec>& points)
      : spline(parameters(points.size()), points),
        profile(detail::fastest_profile(spline, 800, bounds(), kFree).value()) {}

  static std::vector<double> parameters(std::size_t count) {
    std::vector<double> s(count);
    for (std::size_t i = 0; i < count; ++i) s[i] = static_cast<double>(i) / 1000;
    return s;
  }
  static const detail::Bounds& bounds() {
    static const JointVec one = JointVec::Ones(4);
    static const detail::Bounds bounds{3 * one, 5 * one, 100 * one};
    return bounds;
  }
  static constexpr detail::PathBounds kFree{1e100, 1e100, 1e100};
  static constexpr double kWindow = 0.1;  // [s]

  detail::CubicSpline spline;
  detail::SpeedProfile profile;
  detail::SmoothProfile smooth{profile, kWindow};
};

TEST(DensePaths, GiveATimeLawOfBoundedSize) {
  for (const int count : {500, 10000, 10100, 60000}) {
    const std::vector<JointVec> points = dense_path(count, 0);
    const Smoothed made(points);
    const detail::Reference reference = detail::reference_along(
        made.spline, made.smooth, made.profile, Smoothed::kWindow, detail::law_cells(made.spline));
    EXPECT_LE(reference.law.size(), 12000U);
    EXPECT_EQ(reference.law.size() < reference.tau.size(), count > 10001) << count;
    EXPECT_EQ(reference.law.front(), 0U);
    EXPECT_EQ(reference.law.back(), reference.tau.size() - 1);
    EXPECT_TRUE(std::is_sorted(reference.law.begin(), reference.law.end()));
    std::size_t met = 0;
    for (std::size_t i = 0; i < reference.tau.size(); ++i) {
      const detail::PathState &x = reference.states[i], now = made.smooth.at(reference.tau[i]);
      if (x.s == made.spline.knots()[met]) ++met;
      ASSERT_NEAR(now.s, x.s, 1e-9 * made.spline.end());
      ASSERT_NEAR(now.v, x.v, 1e-6 * made.spline.end());
      ASSERT_TRUE(i == 0 || reference.tau[i] > reference.tau[i - 1]);
    }
    EXPECT_EQ(met, points.size());
  }
}

TEST(SmoothProfile, IsTheMeanUnderAHat) {
  const Smoothed made(dense_path(50, 0));
  const detail::SpeedProfile& p = made.profile;
  // The way of the profile at a time, from its cells.
  const auto way = [&](double t) {
    if (t <= 0) return p.s.front();
    if (t >= p.duration()) return p.s.back();
    const auto i =
        static_cast<std::size_t>(std::upper_bound(p.t.begin(), p.t.end(), t) - p.t.begin()) - 1;
    const double x = t - p.t[i], h = p.t[i + 1] - p.t[i];
    const double jerk = (p.a_before[i + 1] - p.a_after[i]) / h;
    return p.s[i] + x * (p.v[i] + x * (p.a_after[i] / 2 + x * jerk / 6));
  };
  const double half = Smoothed::kWindow / 2, end = made.smooth.duration(), d = 1e-5;
  for (double t = 0.003; t < end; t += 0.0127) {
    double sum = 0, weights = 0;
    constexpr int kSamples = 4000;
    for (int k = 0; k < kSamples; ++k) {
      const double before = 2 * half * (k + 0.5) / kSamples;
      const double weight = half - std::abs(before - half);
      sum += weight * way(t - before);
      weights += weight;
    }
    const detail::PathState x = made.smooth.at(t), next = made.smooth.at(t + d),
                            last = made.smooth.at(t - d);
    EXPECT_NEAR(x.s, sum / weights, 1e-7 * made.spline.end()) << t;
    EXPECT_NEAR(x.v, (next.s - last.s) / (2 * d), 1e-6) << t;
    EXPECT_NEAR(x.a, (next.v - last.v) / (2 * d), 1e-3) << t;
    EXPECT_NEAR(x.j, (next.a - last.a) / (2 * d), 0.02 * (std::abs(x.j) + 1)) << t;
  }
}

}  // namespace
}  // namespace mjarm
