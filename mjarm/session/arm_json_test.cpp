#include "mjarm/session/arm_json.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "mjarm/core/json.hpp"
#include "mjarm/model/shipped_test.hpp"

namespace mjarm::session {
namespace {

using mjarm::testing::shipped_arm;
using mjarm::testing::TestArm;

TEST(ArmJson, NumbersReadBackAsTheyWere) {
  TestArm robot = shipped_arm("panda");
  robot.arm.limits.upper[6] = std::numeric_limits<double>::infinity();
  const Result<JsonObject> read = parse_json_object(arm_json(robot.model, robot.arm));
  ASSERT_TRUE(read) << read.error().what;
  const JsonValue& joints = *(*read)->find("joints");
  ASSERT_EQ(joints.size(), robot.arm.joints.size());
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const ArmJoint& joint = robot.arm.joints[i];
    const JsonValue& frame = *joints[i].find("X_PJ");
    EXPECT_EQ(joints[i].find("name")->string(), joint.name);
    ASSERT_EQ(frame.size(), 12U);
    for (std::size_t k = 0; k < 12; ++k) {
      EXPECT_EQ(frame[k].number(),
                k < 3 ? joint.X_PJ.p[static_cast<Eigen::Index>(k)] : joint.X_PJ.R.data()[k - 3]);
    }
  }
  EXPECT_TRUE(joints[6].find("upper")->is_null());
  EXPECT_EQ((*read)->find("home")->size(), 7U);
}

TEST(ArmJson, EachBodyThatTheArmMovesHasItsJoint) {
  const TestArm robot = shipped_arm("ur5e");
  const Result<JsonObject> read = parse_json_object(arm_json(robot.model, robot.arm));
  ASSERT_TRUE(read) << read.error().what;
  const JsonValue& bodies = *(*read)->find("bodies");
  ASSERT_GE(bodies.size(), 6U);
  EXPECT_EQ(bodies[0][1].number(), 0);
  EXPECT_EQ(bodies[bodies.size() - 1][1].number(), 5);
  for (const JsonValue& body : bodies) EXPECT_EQ(body.size(), 9U);
  EXPECT_FALSE((*parse_json_object(arm_json(robot.arm)))->contains("bodies"));
}

}  // namespace
}  // namespace mjarm::session
