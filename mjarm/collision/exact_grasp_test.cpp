#include "mjarm/collision/exact_grasp.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mjarm/collision/exact.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/robot.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using ::testing::HasSubstr;

/// A hand with one driven finger, and another one that is coupled to it or fixed, on a slide along
/// x; the fingers are boxes of 10 x 20 x 40 mm whose inner faces are 40 mm from the middle plane.
std::string two_fingers(const std::string& second, const std::string& things,
                        const std::string& more = "") {
  return R"(<mujoco model="hand"><worldbody><body name="slider"><joint name="x" type="slide"
    axis="1 0 0" range="-5 5" limited="true"/><geom name="rail" size="0.01" mass="1" contype="0" conaffinity="0"/>
    <site name="tip" pos="0 0 -0.1"/>
    <body name="palm" pos="0 0 -0.05"><geom name="palm" type="box" size="0.03 0.08 0.005" mass="1"/>
    <body name="left" pos="0 0.045 -0.05"><joint name="left" type="slide" axis="0 1 0"
      range="-0.04 0" limited="true"/><geom name="left" type="box" size="0.01 0.005 0.02" mass="0.1"/></body>
    <body name="right" pos="0 -0.045 -0.05">)" +
         second + R"(<geom name="right" type="box" size="0.01 0.005 0.02" mass="0.1"/></body>
    </body></body>)" +
         things +
         "</worldbody><actuator><position name='grip' joint='left' kp='100' "
         "ctrlrange='-0.04 0' ctrllimited='true'/></actuator>" +
         more + "</mujoco>";
}

constexpr const char* kCoupled =
    "<joint name='right' type='slide' axis='0 -1 0' range='-0.04 0' limited='true'/>";
constexpr const char* kEquality =
    "<equality><joint joint1='right' joint2='left' polycoef='0 1 0 0 0'/></equality>";

/// In the place of the coupling.
constexpr const char* kSecondDrive =
    "<actuator><position name='grip2' joint='right' kp='100' ctrlrange='-0.04 0' "
    "ctrllimited='true'/></actuator>";

std::string box(const std::string& name, const std::string& pos, const std::string& size) {
  return "<body" + (name.empty() ? "" : " name='" + name + "'") + " pos='" + pos +
         "'><freejoint/><geom type='box' size='" + size + "' mass='0.1'/></body>";
}

struct Hand {
  Model model;
  Arm arm;

  explicit Hand(const std::string& text)
      : model(load(text)), arm(find_arm(model, {.tip = "tip"}).value()) {}
  static Model load(const std::string& text) {
    const support::TempFolder folder;
    return Model::load(folder.write("hand.xml", text)).value();
  }
  [[nodiscard]] SceneState closed(double x) const {
    return close_gripper(model, arm, std::vector{x}, {}).value();
  }
  [[nodiscard]] std::vector<std::string> held(double x) const {
    std::vector<std::string> out;
    for (const AttachedBody& one : closed(x).attached) out.push_back(one.body);
    return out;
  }
};

TEST(CloseGripper, HoldsWhatIsBetweenTheFingersAndNothingElse) {
  const Hand hand(two_fingers(kCoupled,
                              box("between", "0.3 0 -0.1", "0.01 0.02 0.02") +
                                  box("below", "0.6 0 -0.15", "0.01 0.02 0.02") +
                                  box("beside", "0.9 0.09 -0.1", "0.01 0.02 0.02") +
                                  box("tall", "1.2 0 -0.15", "0.01 0.02 0.05"),
                              kEquality));
  ASSERT_TRUE(hand.arm.gripper);
  EXPECT_THAT(hand.held(0.3), ::testing::ElementsAre("between"));
  EXPECT_THAT(hand.held(0.6), ::testing::IsEmpty()) << "the fingers end above it";
  EXPECT_THAT(hand.held(0.9), ::testing::IsEmpty()) << "it is outside of a finger";
  EXPECT_THAT(hand.held(1.2), ::testing::ElementsAre("tall"));
  EXPECT_THAT(hand.held(0), ::testing::IsEmpty());
}

/// What lies off the middle is pushed to where both fingers meet it, by the faces' own figures.
TEST(CloseGripper, FingersThatMoveAlikeBringItToTheirMiddle) {
  for (const auto& [off, more] : {std::pair(-0.018, kEquality), std::pair(-0.005, kEquality),
                                  std::pair(0.0, kSecondDrive), std::pair(0.012, kSecondDrive)}) {
    const Hand hand(two_fingers(
        kCoupled, box("part", "0.3 " + std::to_string(off) + " -0.1", "0.01 0.02 0.02"), more));
    ASSERT_EQ(hand.arm.gripper->drives.size(), more == kSecondDrive ? 2U : 1U);
    const SceneState closed = hand.closed(0.3);
    ASSERT_EQ(closed.attached.size(), 1U) << off;
    const Pose X_WB = fk(hand.arm, std::vector{0.3}) * closed.attached[0].X_TB;
    EXPECT_NEAR(X_WB.p.y(), 0, 6e-4) << off;
    EXPECT_NEAR(X_WB.p.x(), 0.3, 1e-9) << off;
    EXPECT_NEAR(X_WB.p.z(), -0.1, 1e-9) << off;
    // Each finger has come 20 mm: its face was 40 mm from the middle and meets 20 mm there.
    ASSERT_EQ(closed.qpos.size(), 3U + 7U);
    EXPECT_NEAR(closed.qpos[1], -0.02, 6e-4) << off;
    EXPECT_NEAR(closed.qpos[2], -0.02, 6e-4) << off;
  }
}

/// One finger presses against another one that stands.
TEST(CloseGripper, OneFingerPushesUntilTheOtherSideHolds) {
  const Hand hand(two_fingers("", box("", "0.3 -0.01 -0.1", "0.01 0.025 0.02")));
  const SceneState closed = hand.closed(0.3);
  ASSERT_EQ(closed.attached.size(), 1U) << "a body without a name as well";
  EXPECT_THAT(closed.attached[0].body, HasSubstr("#"));
  const Pose X_WB = fk(hand.arm, std::vector{0.3}) * closed.attached[0].X_TB;
  EXPECT_NEAR(X_WB.p.y(), -0.015, 6e-4) << "its face is at that of the right finger";
  EXPECT_NEAR(closed.qpos[1], -0.03, 6e-4);
}

TEST(OpenGripper, LeavesThingsWhereTheArmHasBroughtThem) {
  const Hand hand(two_fingers(kCoupled, box("part", "0.3 0 -0.1", "0.01 0.02 0.02"), kEquality));
  const SceneState closed = hand.closed(0.3);
  const SceneState open = open_gripper(hand.model, hand.arm, std::vector{1.0}, closed).value();
  EXPECT_TRUE(open.attached.empty());
  EXPECT_NEAR(open.qpos[3], 1.0, 1e-9) << "0.7 m further";
  EXPECT_NEAR(open.qpos[1], 0, 1e-12);
  EXPECT_NEAR(open.qpos[2], 0, 1e-12);
  // It is picked up there again, and nowhere else.
  const auto again = close_gripper(hand.model, hand.arm, std::vector{1.0}, open).value();
  EXPECT_EQ(again.attached.size(), 1U);
  EXPECT_TRUE(close_gripper(hand.model, hand.arm, std::vector{0.3}, open).value().attached.empty());
}

TEST(CloseGripper, ThePandaHoldsAPartInTheFrameOfAnyTool) {
  const support::TempFolder folder;
  const Robot panda = load_robot("panda").value();
  const Pose X_WT = fk(panda.arm, as_span(panda.arm.home));
  const std::string pos = std::to_string(X_WT.p.x()) + " " + std::to_string(X_WT.p.y()) + " " +
                          std::to_string(X_WT.p.z());
  const std::string scene =
      "<mujoco><include file='franka_emika_panda/panda.xml'/><worldbody><body name='part' pos='" +
      pos +
      "'><freejoint/><geom type='box' size='0.03 0.03 0.02' mass='0.1'/></body></worldbody>"
      "</mujoco>";
  const Robot robot = load_robot(folder.write("cell.xml", scene).string()).value();
  const SceneState closed =
      close_gripper(robot.model, robot.arm, as_span(robot.arm.home), {}).value();
  ASSERT_EQ(closed.attached.size(), 1U);
  const Arm flange = find_arm(robot.model, {.tip = "panda_link8"}).value();
  const auto there = attached_to(flange, robot.arm, closed.attached);
  const Pose a = X_WT * closed.attached[0].X_TB;
  const Pose b = fk(flange, as_span(robot.arm.home)) * there[0].X_TB;
  EXPECT_LT((a.p - b.p).norm() + (a.R - b.R).norm(), 1e-9);
}

TEST(CloseGripper, SaysWhatDoesNotFit) {
  const Hand hand(two_fingers(kCoupled, "", kEquality));
  const auto error = [&](std::span<const double> q, const SceneState& state) {
    const auto closed = close_gripper(hand.model, hand.arm, q, state);
    return closed ? std::string("none") : closed.error().what;
  };
  EXPECT_THAT(error(std::vector{0.0, 0.0}, {}), HasSubstr("2"));
  EXPECT_THAT(error(std::vector{0.0}, {.qpos = {1, 2}}), HasSubstr("qpos"));
  EXPECT_THAT(error(std::vector{0.0}, {.attached = {{"left", {}}}}), HasSubstr("free joint"));
  EXPECT_EQ(error(std::vector{0.0}, {}), "none");
  Arm bare = hand.arm;
  bare.gripper.reset();
  EXPECT_FALSE(open_gripper(hand.model, bare, std::vector{0.0}, {}));
}

/// A part that lies on a table touches it, and is in it where it is deeper.
TEST(ExactChecker, WhatIsCarriedMayRestOnThings) {
  const auto is_free = [](double depth, double rest_depth) {
    const Hand hand(two_fingers(kCoupled,
                                box("part", "0.3 0 -0.1", "0.01 0.02 0.03") +
                                    "<geom name='table' type='box' size='2 2 0.1' pos='0 0 " +
                                    std::to_string(-0.23 + depth) + "'/>",
                                kEquality));
    const ContactRules rules{
        .attached = {attach_in_place(hand.model, hand.arm, "part", std::vector{0.3}).value()}};
    ExactChecker checker(hand.model, hand.arm, {.rules = rules, .rest_depth = rest_depth});
    const CollisionReport report = checker.check(std::vector{0.3}).value();
    EXPECT_EQ(report.free, checker.is_free(std::vector{0.3}));
    EXPECT_EQ(report.free, report.contacts.empty());
    return report.free;
  };
  EXPECT_FALSE(is_free(5e-4, 0));
  EXPECT_TRUE(is_free(5e-4, 1e-3));
  EXPECT_FALSE(is_free(2e-3, 1e-3));
}

TEST(ExactChecker, TakesTheSceneAsItIsTold) {
  const Hand hand(two_fingers(kCoupled, box("part", "0.3 0 -0.1", "0.01 0.05 0.02"), kEquality));
  std::vector<double> qpos(hand.model.qpos0().begin(), hand.model.qpos0().end());
  qpos[3] = 2;
  ExactChecker before(hand.model, hand.arm), after(hand.model, hand.arm, {.qpos = qpos});
  EXPECT_FALSE(before.is_free(std::vector{0.3}));
  EXPECT_TRUE(before.is_free(std::vector{2.0}));
  EXPECT_TRUE(after.is_free(std::vector{0.3}));
  EXPECT_FALSE(after.is_free(std::vector{2.0}));
  EXPECT_FALSE(ExactChecker::create(hand.model, hand.arm, {.qpos = {1}}));
}

}  // namespace
}  // namespace mjarm
