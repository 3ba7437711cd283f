#include "mjarm/path/joint_path.hpp"

#include <gtest/gtest.h>

#include "tests/support/constants.hpp"

namespace mjarm {
namespace {

using support::kNaN;

TEST(JointLine, GoesStraightFromEndToEnd) {
  const std::vector<double> q0{0.1, -2, 3}, q1{1.1, 0, 1};
  const auto line = joint_line(q0, q1, 101);
  ASSERT_TRUE(line.has_value());
  EXPECT_EQ(line->q.front(), joint_vec(q0));
  EXPECT_EQ(line->q.back(), joint_vec(q1));
  EXPECT_NEAR(line->s.back(), 3, 1e-12);
  EXPECT_NEAR(line->max_step(), 0.02, 1e-12);
  EXPECT_FALSE(joint_line(q0, q1, 1).has_value());
  EXPECT_FALSE(joint_line(q0, std::vector<double>{1.0}, 5).has_value());
  EXPECT_FALSE(joint_line({}, {}, 5).has_value());
  EXPECT_FALSE(joint_line(q0, std::vector<double>{1, 2, kNaN}, 5).has_value());
}

}  // namespace
}  // namespace mjarm
