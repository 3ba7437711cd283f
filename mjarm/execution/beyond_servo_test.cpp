#include "mjarm/execution/beyond_servo.hpp"

#include <gtest/gtest.h>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm {
namespace {

/// From home by `way` of the elbow and back.
Trajectory there_and_back(const Arm& arm, double way) {
  const auto at = [&](double elbow) {
    JointState state = JointState::at_rest(arm.home);
    state.q[2] += elbow;
    return state;
  };
  return Trajectory::through({0, 1, 2}, {at(0), at(way), at(0)}).value();
}

TEST(BeyondServo, NamesTheJointThatIsLedFarthestAndWhatWouldMendIt) {
  const LanguageScope english(Language::english);
  Arm arm = load_robot("ur5e").value().arm;
  EXPECT_FALSE(beyond_servo(arm, there_and_back(arm, 0.5)));
  arm.joints[2].actuator->ctrl_upper = arm.home[2] + 0.3;
  EXPECT_FALSE(beyond_servo(arm, there_and_back(arm, 0.3)));
  const auto beyond = beyond_servo(arm, there_and_back(arm, 0.5));
  ASSERT_TRUE(beyond);
  EXPECT_EQ(beyond->joint, 2);
  EXPECT_NEAR(beyond->q, arm.home[2] + 0.5, 1e-3);
  const std::string what = describe(*beyond, arm);
  EXPECT_NE(what.find("joint \"elbow_joint\" is to go to 2.071"), std::string::npos) << what;
  EXPECT_NE(what.find("widen ctrlrange"), std::string::npos) << what;
}

}  // namespace
}  // namespace mjarm
