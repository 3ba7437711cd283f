#include <gtest/gtest.h>

#include <string>

#include "mjarm/execution/held_part.hpp"
#include "tests/support/temp_folder.hpp"

// What our grippers hold stays where it is, and by friction alone. `mjarm bench pick --set creep`
// measures more.
namespace mjarm {
namespace {

struct GripCase {
  const char* file;  ///< the robot
  const char* geom;  ///< of the part
};

/// The robot and a part, anywhere.
Robot robot_with_part(const support::TempFolder& folder, const GripCase& grip) {
  return load_robot(folder
                        .write("scene.xml", std::string("<mujoco><include file='") + grip.file +
                                                "'/><worldbody><body name='part' pos='0 0 3'>"
                                                "<freejoint/><geom " +
                                                grip.geom + "/></body></worldbody></mujoco>")
                        .string())
      .value();
}

class Grip : public ::testing::TestWithParam<GripCase> {
 protected:
  HeldPart grip(const PhysicsChange& change) const {
    const Robot changed{robot_.model.with_physics(change).value(), robot_.arm};
    return HeldPart::grip(changed, "part").value();
  }

  support::TempFolder folder_;
  Robot robot_ = robot_with_part(folder_, GetParam());
};

TEST_P(Grip, HoldsByFrictionAlone) {
  EXPECT_LT(grip({}).rest(6).value().moved, 1e-5) << "in a tenth of a minute";
  const Creep carried = grip({.timestep = 0.00025}).carry(4).value();
  EXPECT_GT(carried.fastest, 0.4);
  EXPECT_LT(carried.moved, 2e-4);
  EXPECT_GT(grip({.friction = 0}).in_tool().p.norm(), 0.1);
}

constexpr const char* kUr5eGrip = "universal_robots_ur5e/ur5e_gripper.xml";
constexpr const char* kPandaGrip = "franka_emika_panda/panda.xml";
INSTANTIATE_TEST_SUITE_P(
    Parts, Grip,
    ::testing::Values(GripCase{kUr5eGrip, "type='box' size='0.025 0.03 0.03' mass='0.5'"},
                      GripCase{kUr5eGrip, "type='cylinder' size='0.02 0.04' mass='0.2'"},
                      GripCase{kPandaGrip, "type='cylinder' size='0.02 0.03' mass='0.2'"}));

TEST(HeldPart, WhatCannotBeHeldIsNamed) {
  const Robot scene = load_robot("franka_emika_panda/pick.xml").value();
  const auto no_part = HeldPart::grip(scene, "hause");
  ASSERT_FALSE(no_part);
  EXPECT_NE(no_part.error().what.find("house"), std::string::npos) << no_part.error().what;
  EXPECT_FALSE(HeldPart::grip(load_robot("ur5e").value(), "house")) << "it has no gripper";
  const auto blocked = HeldPart::grip(scene, "can");
  ASSERT_FALSE(blocked) << "it reaches into the hand";
  EXPECT_NE(blocked.error().what.find("hand"), std::string::npos) << blocked.error().what;
  const auto in_vain = HeldPart::grip(scene, "house", {}, [] { return true; });
  ASSERT_FALSE(in_vain);
  EXPECT_EQ(in_vain.error().what, stopped().what);
}

}  // namespace
}  // namespace mjarm
