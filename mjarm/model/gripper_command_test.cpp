#include "mjarm/model/gripper_command.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace mjarm {
namespace {

TEST(GripperCommand, GoesFromOpenToClosedAndBack) {
  const GripperDrive drive{.actuator = "g", .id = 0, .ctrl_open = 255, .ctrl_closed = 55};
  EXPECT_EQ(ctrl_for_grip(drive, 0), 255);
  EXPECT_EQ(ctrl_for_grip(drive, 1), 55);
  EXPECT_EQ(ctrl_for_grip(drive, 0.25), 205);
  const Gripper gripper{.drives = {drive}, .joints = {}};
  EXPECT_EQ(grip_of(gripper, std::array{205.0}), 0.25);
  EXPECT_GT(grip_of(gripper, std::array{0.0}), 1);
  EXPECT_FALSE(std::signbit(grip_of(gripper, std::array{255.0})));
}

TEST(GripperCommand, DrivesGoTogetherEachOnItsWay) {
  const Gripper gripper{
      .drives = {{.actuator = "left", .id = 2, .ctrl_open = 0.04, .ctrl_closed = 0},
                 {.actuator = "right", .id = 1, .ctrl_open = -0.3, .ctrl_closed = 0.1}},
      .joints = {}};
  std::array<double, 3> ctrl{7, 8, 9};
  set_grip(gripper, 0.5, ctrl);
  EXPECT_EQ(ctrl[0], 7);
  EXPECT_DOUBLE_EQ(ctrl[1], -0.1);
  EXPECT_DOUBLE_EQ(ctrl[2], 0.02);
  EXPECT_DOUBLE_EQ(grip_of(gripper, ctrl), 0.5);
  set_grip(gripper, 1, ctrl);
  EXPECT_EQ(ctrl[1], 0.1);
  ctrl[1] = -0.3;
  EXPECT_DOUBLE_EQ(grip_of(gripper, ctrl), 0.5);  // one closed, one open
}

}  // namespace
}  // namespace mjarm
