// Joint values as users give them: degrees and millimetres that lack their unit are refused, what
// may be meant is taken.
#include "mjarm/model/joint_values.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <numbers>

namespace mjarm {
namespace {

using ::testing::HasSubstr;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// A hinge with limits, a slide, and a hinge that turns without end.
Arm gantry() {
  Arm arm;
  arm.joints.resize(3);
  arm.joints[0].name = "turn";
  arm.joints[1].name = "rail";
  arm.joints[1].type = JointType::slide;
  arm.joints[2].name = "endless";
  arm.limits.lower = JointVec(3);
  arm.limits.upper = JointVec(3);
  arm.limits.lower << -3, -0.5, -kNever;
  arm.limits.upper << 3, 0.5, kNever;
  return arm;
}

std::string refusal(const std::string& words) {
  const auto q = parse_joint_values(words, gantry());
  return q ? "" : q.error().what;
}

TEST(JointValues, DegreesAndMillimetresWithoutTheirUnitAreRefused) {
  EXPECT_THAT(refusal("90, 0, 0"), HasSubstr("turn = 90 without a unit would be 90 rad (limits -3 "
                                             "to 3): write 90deg, or 90rad"));
  EXPECT_THAT(refusal("0, 300, 0"), HasSubstr("rail = 300 without a unit would be 300 m"));
  EXPECT_THAT(refusal("0, 300, 0"), HasSubstr("write 300mm"));
  EXPECT_THAT(refusal("0, 0, 360"), HasSubstr("write 360deg"));
  // More than 1 rad or 1 m beyond the limits; nearer ones are somebody's mistake of another kind.
  EXPECT_EQ(refusal("3.9, 1.4, 6.28"), "");
  EXPECT_THAT(refusal("4.1, 0, 0"), HasSubstr("write 4.1deg"));
  EXPECT_THAT(refusal("0, 5, 0"), HasSubstr("write 5mm"));
}

TEST(JointValues, WhoWritesTheUnitMeansIt) {
  const auto q = parse_joint_values("90rad,300m,-360deg", gantry());
  ASSERT_TRUE(q) << q.error().what;
  EXPECT_EQ((*q)[0], 90);
  EXPECT_EQ((*q)[1], 300);
  EXPECT_DOUBLE_EQ((*q)[2], -2 * std::numbers::pi);
}

TEST(JointValues, AUnitMustBeOneOfWhatTheJointDoes) {
  EXPECT_THAT(refusal("5cm, 0, 0"), HasSubstr("unknown unit \"cm\""));
  EXPECT_THAT(refusal("0, 5deg, 0"), HasSubstr("unknown unit \"deg\""));
  const auto slide = joint_value({0.05, Quantity::length}, gantry(), 1);
  ASSERT_TRUE(slide);
  EXPECT_EQ(*slide, 0.05);
  EXPECT_THAT(joint_value({1, Quantity::angle}, gantry(), 1).error().what,
              HasSubstr("joint rail slides: a length is needed"));
  EXPECT_THAT(joint_value({1, Quantity::length}, gantry(), 0).error().what,
              HasSubstr("joint turn turns: an angle is needed"));
  EXPECT_EQ(refusal("1, 2"), "3 values are needed, 2 are given");
}

/// Numbers of JSON are in rad and m by definition: only what cannot be is refused.
TEST(JointValues, OfJsonAreRefusedWhereTheyCannotBeRadians) {
  const auto says = [](std::vector<double> q) {
    const auto checked = check_joint_units(q, gantry());
    return checked ? std::string() : checked.error().what;
  };
  EXPECT_THAT(says({90, 0, 0}), HasSubstr("turn = 90 rad is far beyond its limits -3 to 3; angles "
                                          "are in radians here: 90 degrees are 1.5708"));
  EXPECT_THAT(says({0, -250, 0}), HasSubstr("-250 mm are -0.25"));
  EXPECT_EQ(says({5, 2, 1000}), "");  // beyond the limits, or without end
  EXPECT_EQ(says({1e300, -1e300, 0}), "");
}

}  // namespace
}  // namespace mjarm
