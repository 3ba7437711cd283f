#include "mjarm/model/gripper_command.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace mjarm {
namespace {

TEST(GripperCommand, GoesFromOpenToClosedAndBack) {
  Gripper gripper;
  gripper.ctrl_open = 255;
  gripper.ctrl_closed = 55;
  EXPECT_EQ(ctrl_for_grip(gripper, 0), 255);
  EXPECT_EQ(ctrl_for_grip(gripper, 1), 55);
  EXPECT_EQ(ctrl_for_grip(gripper, 0.25), 205);
  EXPECT_EQ(grip_of_ctrl(gripper, 205), 0.25);
  EXPECT_GT(grip_of_ctrl(gripper, 0), 1);
  EXPECT_FALSE(std::signbit(grip_of_ctrl(gripper, 255)));
}

}  // namespace
}  // namespace mjarm
