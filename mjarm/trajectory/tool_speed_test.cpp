#include "mjarm/trajectory/tool_speed.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/trajectory/tool_down_test.hpp"
#include "mjarm/trajectory/tool_motion.hpp"

namespace mjarm {
namespace {

using testing::kDown;
using testing::kSeed;

Arm slow_arm(double velocity, double acceleration = 50, double jerk = 5000) {
  Arm arm = testing::ur5e();
  arm.limits.velocity.setConstant(velocity);
  arm.limits.acceleration.setConstant(acceleration);
  arm.limits.jerk.setConstant(jerk);
  return arm;
}

Curve line_at(double y) { return *Curve::line({{0.4, y, 0.4}, kDown}, {{-0.4, y, 0.4}, kDown}); }

/// Speed of the tool by differences of its place.
double speed_at(const Arm& arm, const Trajectory& motion, double t) {
  const double h = 1e-4;
  return (fk(arm, as_span(motion.at(t + h).q)).p - fk(arm, as_span(motion.at(t - h).q)).p).norm() /
         (2 * h);
}

TEST(SpeedDips, NoneWhereTheSpeedIsKept) {
  const IkSolver ik(slow_arm(10));
  for (const double speed : {0.05, 0.25}) {
    const auto motion =
        plan_tool_motion(ik, line_at(-0.45), kSeed, {.timing = {.tool_speed = speed}});
    ASSERT_TRUE(motion.has_value());
    EXPECT_TRUE(motion->dips.empty()) << describe(motion->dips.front(), ik.arm());
    for (double t = 0.6; t < motion->trajectory.duration() - 0.6; t += 0.01) {
      EXPECT_NEAR(speed_at(ik.arm(), motion->trajectory, t), speed, 0.011 * speed);
    }
  }
}

TEST(SpeedDips, NorAtCornersNorOnShortLegs) {
  const IkSolver ik(slow_arm(10));
  const Curve zigzag =
      *Curve::polyline(std::vector<Pose>{{{0.3, -0.4, 0.4}, kDown},
                                         {{0.3, -0.4, 0.2}, kDown},
                                         {{0.31, -0.4, 0.2}, kDown},
                                         {{0.31, -0.4, 0.2}, kDown * from_euler({0, 0, 1})},
                                         {{0.5, -0.4, 0.2}, kDown * from_euler({0, 0, 1})}});
  const auto motion = plan_tool_motion(ik, zigzag, kSeed);
  ASSERT_TRUE(motion.has_value()) << describe(motion.error(), ik.arm());
  for (const SpeedDip& dip : motion->dips) ADD_FAILURE() << describe(dip, ik.arm());
}

TEST(SpeedDips, NearTheFirstAxisItsVelocityLimitHoldsTheToolBack) {
  // The first axis turns by about atan(x / y): at x = 0, where the tool is 0.134 m beside the
  // wrist's plane, fastest.
  Arm arm = slow_arm(10);
  arm.limits.velocity[0] = 0.8;
  const IkSolver ik(arm);
  const Curve line = line_at(-0.2);
  const auto motion = plan_tool_motion(ik, line, kSeed, {.timing = {.tool_speed = 0.25}});
  ASSERT_TRUE(motion.has_value());
  ASSERT_EQ(motion->dips.size(), 1U);
  const SpeedDip& dip = motion->dips[0];
  EXPECT_EQ(dip.joint, 0);
  EXPECT_EQ(dip.limit, SpeedLimit::velocity);
  // Differences tell the same.
  double least = 1, t_least = 0, from = 0, to = 0;
  for (double t = 0.6; t < motion->trajectory.duration() - 0.6; t += 0.001) {
    const double speed = speed_at(arm, motion->trajectory, t);
    if (speed < 0.2475) {
      from = from == 0 ? t : from;
      to = t;
    }
    if (speed < least) {
      least = speed;
      t_least = t;
    }
  }
  EXPECT_NEAR(dip.least, least, 1e-5);
  EXPECT_NEAR(dip.t_from, from, 0.003);
  EXPECT_NEAR(dip.t_to, to, 0.003);
  const Pose X = fk(arm, as_span(motion->trajectory.at(t_least).q));
  EXPECT_NEAR(line.nearest(X.p).s, dip.s_least, 2e-3);
  EXPECT_LT(dip.s_from, dip.s_least);
  EXPECT_GT(dip.s_to, dip.s_least);
  EXPECT_NE(describe(dip, arm).find("joint1"), std::string::npos) << describe(dip, arm);
}

TEST(SpeedDips, AccelerationAndJerkAreToldApart) {
  for (const bool jerk : {false, true}) {
    const Arm arm = jerk ? slow_arm(50, 500, 6) : slow_arm(50, 0.9, 5000);
    const IkSolver ik(arm);
    const auto motion =
        plan_tool_motion(ik, line_at(-0.2), kSeed, {.timing = {.tool_speed = 0.25}});
    ASSERT_TRUE(motion.has_value());
    ASSERT_FALSE(motion->dips.empty());
    const auto worst =
        std::min_element(motion->dips.begin(), motion->dips.end(),
                         [](const SpeedDip& a, const SpeedDip& b) { return a.kept < b.kept; });
    EXPECT_EQ(worst->limit, jerk ? SpeedLimit::jerk : SpeedLimit::acceleration);
  }
}

/// At the speed asked for no joint would exceed a limit: it is getting there that takes long.
TEST(SpeedDips, OnTheWayToASpeedWhatTheMotionTakesCounts) {
  for (const bool jerk : {false, true}) {
    const Arm arm = jerk ? slow_arm(50, 500, 3) : slow_arm(50, 0.3, 5000);
    const auto motion = plan_tool_motion(IkSolver(arm), line_at(-0.4), kSeed,
                                         {.timing = {.tool_speed = 0.1, .tool_accel = 5}});
    ASSERT_TRUE(motion.has_value());
    ASSERT_FALSE(motion->dips.empty());
    const SpeedDip& first = motion->dips.front();
    EXPECT_LT(first.t_from, 0.1);
    EXPECT_EQ(first.limit, jerk ? SpeedLimit::jerk : SpeedLimit::acceleration);
    EXPECT_NEAR(first.use, 1, 0.1);
  }
}

TEST(KeepSpeed, FailsWithTheJointAndALowerSpeedWorks) {
  Arm arm = slow_arm(10);
  arm.limits.velocity[0] = 0.8;
  const IkSolver ik(arm);
  const Curve line = line_at(-0.2);
  const MotionOptions options{.timing = {.tool_speed = 0.25}, .keep_speed = true};
  const auto motion = plan_tool_motion(ik, line, kSeed, options);
  ASSERT_FALSE(motion.has_value());
  ASSERT_TRUE(motion.error().path.has_value()) << describe(motion.error(), arm);
  const PathFailure& failure = *motion.error().path;
  EXPECT_EQ(failure.code, PathErrc::joint_speed);
  EXPECT_EQ(failure.joint, 0);
  MotionOptions slower = options;
  auto kept = motion;
  for (int k = 0; k < 30 && !kept; ++k) {
    slower.timing.tool_speed *= 0.95;
    kept = plan_tool_motion(ik, line, kSeed, slower);
  }
  ASSERT_TRUE(kept.has_value()) << describe(kept.error(), arm);
  EXPECT_TRUE(kept->dips.empty());
  EXPECT_LE(check_limits(kept->trajectory, arm.limits).worst(), 1 + 1e-6);
  slower.timing.tool_speed *= 1.1;
  EXPECT_FALSE(plan_tool_motion(ik, line, kSeed, slower).has_value());
}

}  // namespace
}  // namespace mjarm
