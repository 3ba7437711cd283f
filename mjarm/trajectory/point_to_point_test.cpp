#include "mjarm/trajectory/point_to_point.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mjarm/trajectory/point_to_point_checks_test.hpp"
#include "tests/support/constants.hpp"

namespace mjarm {
namespace {

using testing::duration;
using testing::limits_of;

using support::kInf;
using support::kNaN;

JointVec one(double x) { return JointVec::Constant(1, x); }
JointVec two(double x, double y) { return Eigen::Vector2d(x, y); }
JointState state(double q, double v = 0, double a = 0) { return {one(q), one(v), one(a)}; }
JointLimits limits(double v, double a, double j) { return limits_of(one(v), one(a), one(j)); }

TEST(PointToPoint, FromRestToRestByTheFormulasOfTheBooks) {
  // All limits met; no cruise; jerk alone.
  EXPECT_NEAR(duration(state(1), state(11), limits(2, 4, 8)), 10. / 2 + 2. / 4 + 4. / 8, 1e-14);
  EXPECT_NEAR(duration(state(0), state(-1), limits(100, 1, 10)), 0.1 + std::sqrt(4.01), 1e-14);
  EXPECT_NEAR(duration(state(0), state(1e-9), limits(3, 5, 100)), 4 * std::cbrt(5e-12), 1e-17);
  EXPECT_EQ(duration(state(2), state(2), limits(3, 5, 100)), 0);
}

TEST(PointToPoint, WithoutSomeOfTheLimits) {
  EXPECT_NEAR(duration(state(0), state(10), limits(2, 4, kInf)), 10. / 2 + 2. / 4, 1e-14);
  EXPECT_NEAR(duration(state(0), state(1), limits(kInf, 4, kInf)), 1, 1e-14);
  EXPECT_NEAR(duration(state(0), state(1), limits(kInf, kInf, 32)), 1, 1e-14);
  EXPECT_NEAR(duration(state(0), state(1), limits(kInf, 1, 10)), 0.1 + std::sqrt(4.01), 1e-14);
  // Stop from 2 at 4, a way of 0.5; go back by the same.
  EXPECT_NEAR(duration(state(0, 2, 9), state(0, 0, 7), limits(5, 4, kInf)), 0.5 + std::sqrt(0.5),
              1e-14);
  EXPECT_NEAR(duration(state(0, 3), state(1, 3), limits(3, 4, kInf)), 1. / 3, 1e-14);
}

TEST(PointToPoint, FromVelocityToVelocity) {
  // Speeding up at the jerk limit takes 2 s and the mean velocity times these.
  EXPECT_NEAR(duration(state(0, 1), state(4, 3), limits(9, 9, 2)), 2, 1e-12);
  // From half way of that.
  EXPECT_NEAR(duration(state(0, 2, 2), state(8. / 3, 3), limits(9, 9, 2)), 1, 1e-12);
  // With the velocity limit on both ends.
  EXPECT_NEAR(duration(state(0, -3), state(-6, -3), limits(3, 5, 100)), 2, 1e-14);
}

TEST(PointToPoint, TheSameLimitsForAllJointsGiveAStraightLine) {
  const JointVec ones = JointVec::Ones(3), zero = JointVec::Zero(3);
  JointVec way(3);
  way << 1, -0.3, 0;
  const auto motion = PointToPoint::solve({ones, zero, zero}, {ones + way, zero, zero},
                                          limits_of(ones, ones, ones));
  ASSERT_TRUE(motion.has_value());
  for (int k = 0; k <= 50; ++k) {
    const JointVec done = motion->at(motion->duration() * k / 50).q - ones;
    EXPECT_LT((done - done[0] * way).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(PointToPoint, HoldsItsEnds) {
  const auto motion = PointToPoint::solve(state(0.3, 1, -2), state(-1, 0.5), limits(3, 5, 100));
  ASSERT_TRUE(motion.has_value());
  for (const double t : {-1.0, 0.0}) {
    EXPECT_EQ(motion->at(t).q[0], 0.3);
    EXPECT_EQ(motion->at(t).v[0], 1);
    EXPECT_EQ(motion->at(t).a[0], -2);
  }
  for (const double t : {motion->duration(), 99.0}) {
    EXPECT_EQ(motion->at(t).q[0], -1);
    EXPECT_EQ(motion->at(t).v[0], 0.5);
    EXPECT_EQ(motion->at(t).a[0], 0);
  }
}

/// Starts beyond a limit: the duration, all of it, and when the limits hold again at the latest.
void expect_return(const JointState& start, double v, double a, double j, double inside) {
  const JointState end = state(1);
  const auto motion = PointToPoint::solve(start, end, limits(v, a, j));
  ASSERT_TRUE(motion.has_value());
  const testing::Worst worst = testing::worst_of(*motion, end, limits(v, a, j), inside + 1e-9);
  EXPECT_LT(worst.velocity, 1e-9);
  EXPECT_LT(worst.acceleration, 1e-9);
  EXPECT_LT(worst.jerk, 1e-12);
  EXPECT_LT(std::max({worst.q, worst.v, worst.a}), 1e-9);
  if (inside > 0) {  // and not before
    const testing::Worst before = testing::worst_of(*motion, end, limits(v, a, j), inside * 0.99);
    EXPECT_GT(std::max(before.velocity, before.acceleration), 1e-9);
  }
}

TEST(PointToPoint, ReturnsWithinTheLimitsAsFastAsItCan) {
  for (const double s : {1.0, -1.0}) {
    expect_return(state(0, 0, 7 * s), 9, 5, 10, 0.2);     // down to the acceleration limit
    expect_return(state(0, 4 * s), 3, 5, 2, 1);           // 1 = j t^2 / 2
    expect_return(state(0, 5 * s), 3, 1, 2, 0.5 + 1.75);  // then on with -1
    expect_return(state(0, 3 * s, 2 * s), 3, 5, 2, 2);    // cannot but overshoot
    expect_return(state(0, 3 * s, -2 * s), 3, 5, 2, 0);   // comes back by itself
  }
  // Full braking to 0.01 would overshoot -0.01: it starts to let go before.
  const auto narrow = PointToPoint::solve(state(0, 1), state(1), limits(0.01, 5, 2));
  ASSERT_TRUE(narrow.has_value());
  for (const auto& piece : narrow->pieces(0)) EXPECT_GE(piece.v, -0.01 - 1e-12);
  // What rounding leaves beyond a limit is no reason to brake.
  EXPECT_NEAR(duration(state(0, 3 * (1 + 1e-15)), state(1, 3), limits(3, 4, 50)), 1. / 3, 1e-12);
}

TEST(PointToPoint, SaysWhyThereIsNone) {
  const auto code = [](const JointState& start, const JointState& end, const JointLimits& bounds) {
    const auto motion = PointToPoint::solve(start, end, bounds);
    EXPECT_FALSE(motion.has_value());
    const auto words = point_to_point(start, end, bounds);
    EXPECT_FALSE(words.has_value());
    EXPECT_NE(words.has_value() ? "" : words.error().what, "");
    return motion ? PointToPointErrc{} : motion.error().code;
  };
  using enum PointToPointErrc;
  const JointLimits good = limits(1, 2, 3);
  const JointState still{two(0, 0), two(0, 0), two(0, 0)};
  EXPECT_EQ(code(state(0), still, good), bad_states);
  EXPECT_EQ(code({{}, {}, {}}, {{}, {}, {}}, limits_of({}, {}, {})), bad_states);
  EXPECT_EQ(code({one(0), {}, one(0)}, state(0), good), bad_states);
  EXPECT_EQ(code(state(kNaN), state(0), good), bad_states);
  EXPECT_EQ(code(state(0), state(0, 0, kInf), good), bad_states);
  EXPECT_EQ(code(state(-1e308), state(1e308), good), bad_states);
  EXPECT_EQ(code(still, still, good), bad_limits);
  for (const double bad : {0.0, -1.0, kNaN}) {
    EXPECT_EQ(code(state(0), state(1), limits(bad, 2, 3)), bad_limits);
    EXPECT_EQ(code(state(0), state(1), limits(1, bad, 3)), bad_limits);
    EXPECT_EQ(code(state(0), state(1), limits(1, 2, bad)), bad_limits);
  }
  EXPECT_EQ(code(state(0), state(1), limits(1, kInf, kInf)), bad_limits);
  EXPECT_EQ(code(state(0), state(1, 1.1), good), end_outside);
  EXPECT_EQ(code(state(0), state(1, 0, -2.1), good), end_outside);
  EXPECT_EQ(code(state(0), state(1, -0.8, 1.9), good), end_outside);  // from -1.4
  const auto failure =
      PointToPoint::solve(still, {still.q, JointVec::Unit(2, 1) * 5, still.a},
                          limits_of(JointVec::Ones(2), JointVec::Ones(2), JointVec::Ones(2)));
  ASSERT_FALSE(failure.has_value());
  EXPECT_EQ(failure.error().joint, 1);
}

TEST(PointToPoint, AsATrajectory) {
  const JointState start{two(0.3, 1), two(1, -1), two(-2, 0)};
  const JointState end{two(-1, -2), two(0.5, 0.1), two(0, 0)};
  const JointLimits bounds =
      limits_of(JointVec::Constant(2, 3), JointVec::Constant(2, 5), JointVec::Constant(2, 100));
  const auto trajectory = point_to_point(start, end, bounds);
  ASSERT_TRUE(trajectory.has_value()) << trajectory.error().what;
  const auto motion = PointToPoint::solve(start, end, bounds);
  EXPECT_NEAR(trajectory->duration(), motion->duration(), 1e-14);
  for (int k = 0; k <= 100; ++k) {
    const double t = motion->duration() * k / 100;
    const JointState x = trajectory->at(t), y = motion->at(t);
    EXPECT_LT((x.q - y.q).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LT((x.v - y.v).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LT((x.a - y.a).cwiseAbs().maxCoeff(), 1e-11);
  }
  const LimitUse use = check_limits(*trajectory, bounds, 1e-4);
  EXPECT_LE(use.worst(), 1 + 1e-9);
  EXPECT_LE(use.jerk.maxCoeff(), 1 + 1e-9);
  EXPECT_GT(use.jerk.maxCoeff(), 0.99);
  EXPECT_EQ(point_to_point(start, start, bounds)->duration(), 0);
}

TEST(PointToPoint, AsATrajectoryStaysInTheRange) {
  JointLimits bounds = limits(3, 5, 100);
  bounds.upper[0] = 1;
  EXPECT_TRUE(point_to_point(state(0), state(1), bounds).has_value());
  EXPECT_TRUE(point_to_point(state(2), state(3), bounds).has_value());
  const auto beyond = point_to_point(state(0.9, 2), state(0), bounds);  // stops after 0.4 and more
  ASSERT_FALSE(beyond.has_value());
  EXPECT_EQ(beyond.error().code, Errc::impossible);
  EXPECT_NE(beyond.error().what.find("joint 1"), std::string::npos) << beyond.error().what;
  bounds.upper[0] = 1.5;
  EXPECT_TRUE(point_to_point(state(0.9, 2), state(0), bounds).has_value());
  bounds.lower = bounds.upper = {};
  EXPECT_TRUE(point_to_point(state(0.9, 2), state(0), bounds).has_value());
}

}  // namespace
}  // namespace mjarm
