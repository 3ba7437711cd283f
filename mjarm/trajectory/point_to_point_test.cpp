#include "mjarm/trajectory/point_to_point.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mjarm/core/rng.hpp"

namespace mjarm {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

JointVec one(double x) { return JointVec::Constant(1, x); }
JointState state(double q, double v = 0, double a = 0) { return {one(q), one(v), one(a)}; }

JointLimits limits_of(double v, double a, double j) {
  return {one(-kInf), one(kInf), one(v), one(a), one(j), {}, {}};
}

double duration(const JointState& start, const JointState& end, const JointLimits& limits) {
  const auto motion = PointToPoint::solve(start, end, limits);
  EXPECT_TRUE(motion.has_value());
  return motion ? motion->duration() : -1;
}

TEST(PointToPoint, FromRestToRestByTheFormulasOfTheBooks) {
  // All limits met; no cruise; jerk alone.
  EXPECT_NEAR(duration(state(1), state(11), limits_of(2, 4, 8)), 10.0 / 2 + 2.0 / 4 + 4.0 / 8,
              1e-14);
  EXPECT_NEAR(duration(state(0), state(-1), limits_of(100, 1, 10)), 0.1 + std::sqrt(0.01 + 4),
              1e-14);
  EXPECT_NEAR(duration(state(0), state(1e-9), limits_of(3, 5, 100)), 4 * std::cbrt(1e-9 / 200),
              1e-17);
  EXPECT_EQ(duration(state(2), state(2), limits_of(3, 5, 100)), 0);
}

TEST(PointToPoint, WithoutSomeOfTheLimits) {
  EXPECT_NEAR(duration(state(0), state(10), limits_of(2, 4, kInf)), 10.0 / 2 + 2.0 / 4, 1e-14);
  EXPECT_NEAR(duration(state(0), state(1), limits_of(kInf, 4, kInf)), 1, 1e-14);
  EXPECT_NEAR(duration(state(0), state(1), limits_of(kInf, kInf, 32)), 1, 1e-14);
  EXPECT_NEAR(duration(state(0), state(1), limits_of(kInf, 1, 10)), 0.1 + std::sqrt(0.01 + 4),
              1e-14);
}

TEST(PointToPoint, AsATrajectory) {
  const JointState start = state(0.3, 1, -2), end = state(-1, 0.5);
  const auto trajectory = point_to_point(start, end, limits_of(3, 5, 100));
  ASSERT_TRUE(trajectory.has_value()) << trajectory.error().what;
  const auto motion = PointToPoint::solve(start, end, limits_of(3, 5, 100));
  EXPECT_NEAR(trajectory->duration(), motion->duration(), 1e-14);
  for (int k = 0; k <= 100; ++k) {
    const double t = motion->duration() * k / 100;
    EXPECT_NEAR(trajectory->at(t).q[0], motion->at(t).q[0], 1e-13);
    EXPECT_NEAR(trajectory->at(t).v[0], motion->at(t).v[0], 1e-13);
  }
  EXPECT_LE(check_limits(*trajectory, limits_of(3, 5, 100)).worst(), 1 + 1e-9);
}

}  // namespace
}  // namespace mjarm
