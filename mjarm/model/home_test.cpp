#include "mjarm/model/home.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include "mjarm/model/find_arm.hpp"

namespace mjarm {
namespace {

/// Two arms of a joint each, with these keyframes.
Model two_arms(const std::string& keys) {
  const auto arm = [](const std::string& name) {
    return "<body name='" + name + "'><joint name='" + name + "' axis='0 0 1' range='-1 2'/>" +
           "<geom type='capsule' fromto='0 0 0 .1 0 0' size='.01'/><site name='tip_" + name +
           "' pos='.1 0 0'/></body>";
  };
  return Model::from_mjcf("<mujoco><compiler angle='radian'/><worldbody>" + arm("a") + arm("b") +
                          "</worldbody><keyframe>" + keys + "</keyframe></mujoco>")
      .value();
}

/// The arm and all else stand in the same keyframe: `home`, else the only one.
TEST(Home, IsOneForTheArmAndAllElse) {
  struct Case {
    const char* keys;
    int number;
    double arm, other;
  };
  constexpr double kMiddle = 0.5;  // of the limits
  for (const Case& is :
       {Case{"", -1, kMiddle, 0},
        {"<key name='neutral_pose' qpos='.1 .2'/>", 0, .1, .2},
        {"<key qpos='.1 .2'/>", 0, .1, .2},
        {"<key name='rest' qpos='.1 .2'/><key name='home' qpos='.3 .4'/>", 1, .3, .4},
        {"<key name='rest' qpos='.1 .2'/><key name='up' qpos='.3 .4'/>", -1, kMiddle, 0}}) {
    const Model model = two_arms(is.keys);
    EXPECT_EQ(home_keyframe(model.raw()), is.number) << is.keys;
    EXPECT_EQ(home_configuration(model.raw())[1], is.other) << is.keys;
    EXPECT_EQ(find_arm(model, {.tip = "tip_a"}).value().home[0], is.arm) << is.keys;
    const Pose other = frame_pose(model, "tip_b").value();
    EXPECT_NEAR(other.p.y(), .1 * std::sin(is.other), 1e-12) << is.keys;
  }
}

}  // namespace
}  // namespace mjarm
