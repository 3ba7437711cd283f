#include "mjarm/model/servo_range.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace mjarm {
namespace {

ArmJoint driven_by(ArmActuator actuator) {
  ArmJoint joint;
  joint.actuator = std::move(actuator);
  return joint;
}

TEST(ServoRange, IsWhatCommandsAreAsJointValues) {
  const ServoRange plain = servo_range(driven_by(
      {.name = "s", .gain = 100, .bias = {0, -100, -10}, .ctrl_lower = -1, .ctrl_upper = 2}));
  EXPECT_EQ(plain.lower, -1);
  EXPECT_EQ(plain.upper, 2);
  const ServoRange geared = servo_range(driven_by({.name = "s",
                                                   .gear = -2,
                                                   .gain = 100,
                                                   .bias = {50, -100, -10},
                                                   .ctrl_lower = -1,
                                                   .ctrl_upper = 2}));
  EXPECT_DOUBLE_EQ(geared.lower, -1.25);
  EXPECT_DOUBLE_EQ(geared.upper, 0.25);
}

TEST(ServoRange, IsEverythingWhereNoCommandIsAPlace) {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  const ArmActuator motor{.name = "s", .gain = 1, .ctrl_lower = -1, .ctrl_upper = 1};
  const ArmActuator unlimited{
      .name = "s", .gain = 100, .bias = {0, -100, 0}, .ctrl_lower = -kAny, .ctrl_upper = kAny};
  for (const ArmJoint& joint : {ArmJoint{}, driven_by(motor), driven_by(unlimited)}) {
    EXPECT_EQ(servo_range(joint).lower, -kAny);
    EXPECT_EQ(servo_range(joint).upper, kAny);
  }
}

}  // namespace
}  // namespace mjarm
