#include "mjarm/trajectory/at_speed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/path/solve_path.hpp"
#include "tests/support/constants.hpp"

namespace mjarm {
namespace {

class AtSpeed : public ::testing::Test {
 protected:
  AtSpeed() {
    arm_.limits.velocity.setConstant(std::numbers::pi);
    arm_.limits.acceleration.setConstant(5);
    arm_.limits.jerk.setConstant(100);
  }
  /// 0.3 m beside the base, the tool down.
  JointPath line(double length = 0.3) const {
    const auto pose = [](double x) { return Pose{{x, -0.45, 0.3}, from_euler({3.14, 0, 0})}; };
    const Curve curve = Curve::line(pose(-0.15), pose(-0.15 + length)).value();
    const std::vector<double> s = curve.stations(0.001, 0.02);
    const std::vector<double> seed{-1.57, -1.34, 2.65, -1.3, 1.55, 0};
    return solve_path(IkSolver(arm_), curve.poses(s), s, seed).value();
  }
  /// [m/s] of the tool.
  double speed(const Trajectory& motion, double t) const {
    constexpr double kStep = 1e-5;
    const auto place = [&](double x) { return fk(arm_, as_span(motion.at(x).q)).p; };
    return (place(t + kStep) - place(t)).norm() / kStep;
  }

  Arm arm_ = testing::ur5e();
};

TEST_F(AtSpeed, BeginsAtTheSpeedAskedForAndSavesTheTimeToGetThere) {
  const JointPath path = line();
  for (const double asked : {0.02, 0.1, 0.4}) {
    const TimingOptions options{.tool_speed = asked};
    const Trajectory rest = time_tool_path(path, {}, arm_.limits, options).value();
    const Trajectory moving = time_tool_path_at_speed(path, {}, arm_.limits, options).value();
    EXPECT_LT((moving.at(0).q - path.q.front()).norm(), 1e-9);
    EXPECT_EQ(moving.at(moving.duration()).q, path.q.back());
    EXPECT_EQ(moving.at(moving.duration()).v.norm(), 0);
    EXPECT_NEAR(speed(moving, 0), asked, 1e-3 * asked);
    // Half of the time of speeding up is lost from rest: v / a + ramp, or less where it is short.
    const double saved = rest.duration() - moving.duration();
    EXPECT_GT(saved, 0.4 * asked);
    EXPECT_LT(saved, 0.5 * asked + 0.06);
    const LimitUse use = check_limits(moving, arm_.limits, moving.duration() / 5003);
    EXPECT_LE(use.worst(), 1 + 1e-6);
    EXPECT_LE(use.jerk.maxCoeff(), 1 + 1e-6);
  }
}

/// All along the line, its first moments included.
TEST_F(AtSpeed, GoesTheSameWay) {
  const JointPath path = line();
  const Trajectory moving = time_tool_path_at_speed(path, {}, arm_.limits).value();
  for (int i = 0; i <= 100; ++i) {
    const Pose X = fk(arm_, as_span(moving.at(moving.duration() * i / 100).q));
    EXPECT_NEAR(X.p.y(), -0.45, 1e-6);
    EXPECT_NEAR(X.p.z(), 0.3, 1e-6);
  }
}

TEST_F(AtSpeed, StopsAtCornersButNotAtTheStart) {
  const JointPath path = line();
  const std::vector<double> stops{0, path.s[path.s.size() / 2], path.s.back()};
  const Trajectory moving = time_tool_path_at_speed(path, stops, arm_.limits).value();
  EXPECT_GT(speed(moving, 0), 0.24);
  int rests = 0;
  bool resting = false;
  for (double t = 0; t < moving.duration() - 0.02; t += 1e-3) {
    const bool now = moving.at(t).v.norm() < 1e-3;
    rests += now && !resting ? 1 : 0;
    resting = now;
  }
  EXPECT_EQ(rests, 1);
}

/// The joints cannot be as fast as that, nor is the way long enough.
TEST_F(AtSpeed, WhatCannotBeAsFastIsSlower) {
  for (const double length : {0.3, 0.01}) {
    const Trajectory moving =
        time_tool_path_at_speed(line(length), {}, arm_.limits, {.tool_speed = 5}).value();
    EXPECT_GT(speed(moving, 0), 0);
    EXPECT_LT(speed(moving, 0), 5);
    const LimitUse use = check_limits(moving, arm_.limits, moving.duration() / 5003);
    EXPECT_LE(use.worst(), 1 + 1e-6);
    EXPECT_LE(use.jerk.maxCoeff(), 1 + 1e-6);
  }
}

TEST_F(AtSpeed, RefusesWhatTimingRefuses) {
  JointPath path = line();
  EXPECT_FALSE(time_tool_path_at_speed({}, {}, arm_.limits));
  const std::vector<double> nowhere{0.12345678};
  EXPECT_FALSE(time_tool_path_at_speed(path, nowhere, arm_.limits));
  path.q[3][1] = support::kNaN;
  EXPECT_FALSE(time_tool_path_at_speed(path, {}, arm_.limits));
}

TEST_F(AtSpeed, PartsAreWhatTheWholeDoes) {
  const Trajectory whole = time_tool_path(line(), {}, arm_.limits).value();
  const double from = 0.123, to = 0.789;
  const Trajectory part = part_of(whole, from, to).value();
  EXPECT_NEAR(part.duration(), to - from, 1e-15);
  for (int i = 0; i <= 200; ++i) {
    const double t = (to - from) * i / 200;
    const JointState a = part.at(t), b = whole.at(from + t);
    EXPECT_LT((a.q - b.q).norm(), 1e-12);
    EXPECT_LT((a.v - b.v).norm(), 1e-9);
    EXPECT_LT((a.a - b.a).norm(), 1e-6);
  }
  EXPECT_FALSE(part_of(whole, 0.5, 0.5));
  EXPECT_FALSE(part_of(whole, -0.1, 0.5));
  EXPECT_FALSE(part_of(whole, 0, whole.duration() + 0.1));
}

}  // namespace
}  // namespace mjarm
