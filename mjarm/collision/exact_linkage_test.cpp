// Grippers whose fingers hang in closed loops: where their links go has a closed form.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "mjarm/collision/exact_grasp.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/find_arm.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

constexpr double kCrank = 0.06;  // [m] from pivot to finger
constexpr double kPivot = 0.03;  // [m] from the middle plane

/// A parallelogram a finger: crank and rocker of equal length, 20 mm apart, so that the finger
/// keeps its direction and its face stands at kPivot + kCrank sin(q) from the middle plane.
std::string linkage(const std::string& side, const std::string& y, const std::string& axis) {
  const std::string link =
      "<geom type='capsule' size='0.004' fromto='0 0 0 0 0 -0.06' mass='0.02' "
      "contype='0' conaffinity='0'/>";
  return "<body name='" + side + "_crank' pos='0 " + y + "0.03 0'><joint name='" + side +
         "_driver' axis='" + axis +
         "' range='-0.5 0.6' limited='true' damping='0.05' "
         "armature='0.002'/>" +
         link + "<body name='" + side +
         "_finger' pos='0 0 -0.06'>"
         "<joint name='" +
         side +
         "_follower' axis='1 0 0' armature='0.0005'/>"
         "<geom type='box' size='0.01 0.005 0.02' pos='0 " +
         y +
         "0.005 -0.03' mass='0.03'/>"
         "</body></body><body name='" +
         side + "_rocker' pos='0 " + y +
         "0.05 0'>"
         "<joint name='" +
         side + "_rocker' axis='1 0 0' armature='0.0005'/>" + link + "</body>";
}

std::string loop(const std::string& side, const std::string& y) {
  return "<connect body1='" + side + "_finger' body2='" + side + "_rocker' anchor='0 " + y +
         "0.02 0' solref='0.005 1' solimp='0.99 0.999 0.001'/>";
}

/// The hand on a slide along x, and a box of 40 mm before it, `off` from the middle plane.
std::string four_bar_hand(const std::string& off) {
  return R"(<mujoco model="four bars"><option integrator="implicitfast"/><compiler angle="radian"/>
    <worldbody><body name="slider"><joint name="x" type="slide" axis="1 0 0" range="-5 5"
      limited="true"/><geom size="0.01" mass="1" contype="0" conaffinity="0"/>
      <site name="tip" pos="0 0 -0.14"/><body name="palm" pos="0 0 -0.05">
      <geom type="box" size="0.03 0.08 0.005" pos="0 0 0.02" mass="1"/>)" +
         linkage("left", "", "1 0 0") + linkage("right", "-", "-1 0 0") + R"(</body></body>
    <body name="part" pos="0.3 )" +
         off + R"( -0.14"><freejoint/><geom type="box"
      size="0.01 0.02 0.02" mass="0.1"/></body></worldbody>
    <tendon><fixed name="split"><joint joint="left_driver" coef="0.5"/>
      <joint joint="right_driver" coef="0.5"/></fixed></tendon>
    <equality>)" +
         loop("left", "") + loop("right", "-") +
         R"(<joint joint1="left_driver" joint2="right_driver" polycoef="0 1 0 0 0"
      solref="0.005 1"/></equality>
    <actuator><position name="grip" tendon="split" kp="20" kv="0.5" ctrlrange="-0.5 0.6"/></actuator>
    </mujoco>)";
}

struct FourBars {
  Model model;
  Arm arm;

  explicit FourBars(const std::string& off)
      : model(load(four_bar_hand(off))), arm(find_arm(model, {.tip = "tip"}).value()) {}
  static Model load(const std::string& text) {
    const support::TempFolder folder;
    return Model::load(folder.write("hand.xml", text)).value();
  }
  /// The slide, then crank, follower and rocker of each side.
  static void expect_parallel(const SceneState& state, double angle, double slack) {
    for (const std::size_t side : {0U, 1U}) {
      const double turn = side == 0 ? 1 : -1;
      const double crank = state.qpos[1 + 3 * side];
      EXPECT_NEAR(crank, angle, slack) << side;
      EXPECT_NEAR(state.qpos[2 + 3 * side], -turn * crank, 2e-3)
          << "the finger keeps its direction";
      EXPECT_NEAR(state.qpos[3 + 3 * side], turn * crank, 2e-3) << "the rocker is parallel";
    }
  }
};

TEST(Linkage, AHandOfFourBarsHoldsWhatIsBetweenItsFingers) {
  for (const char* off : {"0", "0.008", "-0.004"}) {
    SCOPED_TRACE(off);
    const FourBars hand(off);
    ASSERT_TRUE(hand.arm.gripper);
    const SceneState open = open_gripper(hand.model, hand.arm, std::vector{0.3}, {}).value();
    FourBars::expect_parallel(open, 0.6, 0.02);
    const SceneState closed = close_gripper(hand.model, hand.arm, std::vector{0.3}, open).value();
    ASSERT_EQ(closed.attached.size(), 1U);
    EXPECT_EQ(closed.attached[0].body, "part");
    // Faces meet the box, 20 mm from the middle plane to either side.
    FourBars::expect_parallel(closed, std::asin((0.02 - kPivot) / kCrank), 0.015);
    const Pose X_WB = fk(hand.arm, std::vector{0.3}) * closed.attached[0].X_TB;
    EXPECT_NEAR(X_WB.p.y(), 0, 1e-3);
    EXPECT_NEAR(X_WB.p.x(), 0.3, 1e-9);
  }
}

TEST(Linkage, WithNothingBetweenTheyCloseToTheirEnds) {
  const FourBars hand("0");
  const SceneState open = open_gripper(hand.model, hand.arm, std::vector{0.0}, {}).value();
  const SceneState closed = close_gripper(hand.model, hand.arm, std::vector{0.0}, open).value();
  EXPECT_TRUE(closed.attached.empty());
  FourBars::expect_parallel(closed, -0.5, 0.02);
  EXPECT_EQ(closed.qpos[0], 0) << "the arm stays";
  EXPECT_NEAR(closed.qpos[7], 0.3, 1e-12) << "and so does the part";
  const SceneState again = close_gripper(hand.model, hand.arm, std::vector{0.0}, open).value();
  EXPECT_EQ(again.qpos, closed.qpos);
}

}  // namespace
}  // namespace mjarm
