#include "mjarm/teleop/input_file.hpp"

#include <gtest/gtest.h>

namespace mjarm {
namespace {

TEST(TeleopInputFile, ReadsWhatItWrites) {
  std::vector<TimedInput> inputs(2);
  inputs[0].input = {.linear = {0.1, -0.2, 1e-3}, .angular = {1, 2, 1.0 / 3}, .grip_to = 0.25};
  inputs[1].time = 0.004;
  inputs[1].input.grip_to = 1;
  inputs[1].input.frame = TwistFrame::tool;
  const auto read = parse_inputs(inputs_csv(inputs), TwistFrame::tool, "file.csv");
  ASSERT_TRUE(read) << read.error().what;
  ASSERT_EQ(read->size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ((*read)[i].time, inputs[i].time);
    EXPECT_EQ((*read)[i].input.linear, inputs[i].input.linear);
    EXPECT_EQ((*read)[i].input.angular, inputs[i].input.angular);
    EXPECT_EQ((*read)[i].input.grip_to, inputs[i].input.grip_to);
    EXPECT_EQ((*read)[i].input.frame, inputs[i].input.frame);
  }
}

TEST(TeleopInputFile, NeedsNoHeadAndPassesOverEmptyLines) {
  const auto read =
      parse_inputs("\n0,0,0,0,0,0,0,0\r\n\n 1, 0.1,0,0, 0,0,0, 1\n", TwistFrame::world, "f");
  ASSERT_TRUE(read) << read.error().what;
  ASSERT_EQ(read->size(), 2U);
  EXPECT_EQ((*read)[1].input.linear.x(), 0.1);
  EXPECT_EQ((*read)[0].input.frame, TwistFrame::world);
}

TEST(TeleopInputFile, NamesTheLineThatDoesNotFit) {
  const struct {
    const char* csv;
    const char* where;
  } kFaults[] = {{"", "f.csv"},
                 {"time,vx,vy,vz,wx,wy,wz,gripper\n", "f.csv"},
                 {"0,0,0,0,0,0,0,0\n1,2,3\n", "f.csv:2"},
                 {"0,0,0,0,0,0,0,0\n0,0,0,0,0,0,0,0\n", "f.csv:2"},
                 {"0,0,0,0,0,0,0,1.5\n", "f.csv:1"},
                 {"0,0,0,0,0,0,0,0,2\n", "f.csv:1"},
                 {"-1,0,0,0,0,0,0,0\n", "f.csv:1"},
                 {"0,nan,0,0,0,0,0,0\n", "f.csv:1"},
                 {"time,vx\n0,0,0,0,0,0,0,0\n", "f.csv:1"},
                 {"\xff\xfe\n", "f.csv:1"}};
  for (const auto& fault : kFaults) {
    const auto read = parse_inputs(fault.csv, TwistFrame::world, "f.csv");
    ASSERT_FALSE(read) << fault.csv;
    EXPECT_EQ(read.error().code, Errc::bad_input);
    EXPECT_NE(read.error().what.find(fault.where), std::string::npos) << read.error().what;
  }
}

}  // namespace
}  // namespace mjarm
