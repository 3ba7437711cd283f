#include "mjarm/program/control_trial.hpp"

#include <gtest/gtest.h>

#include "mjarm/model/find_arm.hpp"

namespace mjarm {
namespace {

struct Ur5e {
  Model model = Model::load(find_model_file("ur5e").value()).value();
  Arm arm = find_arm(model).value();
};

TEST(ControlTrial, ALapStaysOnTheEllipseAtBothSpeeds) {
  const Ur5e robot;
  for (const double seconds : {10.0, 4.0}) {
    const auto lap = drive_lap(robot.model, robot.arm, {.seconds = seconds});
    ASSERT_TRUE(lap.has_value()) << lap.error().what;
    EXPECT_LT(lap->error.max, 1e-6);
    EXPECT_LT(lap->lag, 1e-6);
    EXPECT_EQ(lap->error.coverage, 1);
    EXPECT_NEAR(lap->peak_speed, 2.725 / seconds, 0.01 / seconds);
    EXPECT_EQ(lap->limited_steps, 0);
  }
}

TEST(ControlTrial, TheServoCoversNothing) {
  const Ur5e robot;
  const auto lap = drive_lap(robot.model, robot.arm, {.mode = ControlMode::servo});
  ASSERT_TRUE(lap.has_value()) << lap.error().what;
  EXPECT_GT(lap->error.max, 0.01);
  EXPECT_LT(lap->error.coverage, 0.1);
}

TEST(ControlTrial, AnUnknownLoadIsTakenUpByTheIntegral) {
  const Ur5e robot;
  LapOptions options{.payload = 1};
  const auto without = drive_lap(robot.model, robot.arm, options);
  options.control = {.stiffness = 4800, .damping = 120, .integral = 64000};
  const auto with = drive_lap(robot.model, robot.arm, options);
  ASSERT_TRUE(without && with);
  EXPECT_GT(without->second_half, 1e-3);
  EXPECT_LT(with->second_half, 2e-5);
  EXPECT_EQ(with->error.coverage, 1);
}

TEST(ControlTrial, RestIsExactButForTheServo) {
  const Ur5e robot;
  const auto exact = rest_errors(robot.model, robot.arm, ControlMode::computed_torque, 10);
  const auto sagging = rest_errors(robot.model, robot.arm, ControlMode::servo, 10);
  ASSERT_TRUE(exact && sagging);
  EXPECT_EQ(exact->poses, 10);
  EXPECT_LT(exact->worst.position, 1e-9);
  EXPECT_LT(exact->worst.rotation, 1e-9);
  EXPECT_GT(sagging->worst.position, 5e-3);
}

TEST(ControlTrial, ALapOutOfReachIsRefused) {
  const Ur5e robot;
  EXPECT_FALSE(drive_lap(robot.model, robot.arm, {.center = {0, -1, 0.4}}).has_value());
}

}  // namespace
}  // namespace mjarm
