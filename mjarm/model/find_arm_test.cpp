#include "mjarm/model/find_arm.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>
#include <sstream>

#include "mjarm/core/rng.hpp"
#include "mjarm/model/shipped_test.hpp"
#include "mjarm/model/test_chain_internal.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using ::testing::HasSubstr;

Model from_text(std::string_view xml) {
  const support::TempFolder folder;
  auto model = Model::load(folder.write("model.xml", xml));
  EXPECT_TRUE(model) << (model ? "" : model.error().what);
  return *model;
}

/// A chain of bodies, each with the same joint text inside, `%` standing for a number.
std::string serial(int count, std::string joint = "<joint name=\"%j\"/>", std::string prefix = "") {
  std::string xml;
  for (int i = 0; i < count; ++i) {
    std::string here = joint;
    here.replace(here.find('%'), 1, prefix + std::to_string(i));
    xml += "<body name=\"" + prefix + "b" + std::to_string(i) + "\" pos=\"0 0 .1\">" + here +
           "<geom size=\".01\"/>";
  }
  return xml;
}
std::string close(int count) {
  std::string xml;
  for (int i = 0; i < count; ++i) xml += "</body>";
  return xml;
}
std::string world(const std::string& inside, const std::string& rest = "") {
  return "<mujoco><compiler angle=\"radian\"/><worldbody>" + inside + "</worldbody>" + rest +
         "</mujoco>";
}

TEST(FindArm, Ur5e) {
  const Model model = testing::shipped("ur5e");
  const auto arm = find_arm(model);
  ASSERT_TRUE(arm) << arm.error().what;
  EXPECT_EQ(arm->dof(), 6);
  EXPECT_EQ(arm->tip, "attachment_site");
  EXPECT_EQ(arm->joints[0].name, "shoulder_pan_joint");
  EXPECT_FALSE(arm->gripper);
  for (int i = 0; i < 6; ++i) {
    ASSERT_TRUE(arm->joints[i].actuator);
    EXPECT_EQ(arm->joints[i].actuator->id, i);
    EXPECT_DOUBLE_EQ(arm->limits.velocity[i], std::numbers::pi);
    EXPECT_DOUBLE_EQ(arm->limits.acceleration[i], 5);
    EXPECT_DOUBLE_EQ(arm->limits.torque[i], i < 3 ? 150 : 28);
    EXPECT_EQ(arm->limits.sources[i].velocity, LimitSource::table);
    EXPECT_EQ(arm->limits.sources[i].torque, LimitSource::file);
    EXPECT_DOUBLE_EQ(arm->joints[i].armature, 0.1);
  }
  EXPECT_DOUBLE_EQ(arm->joints[0].actuator->gain, 2000);
  EXPECT_DOUBLE_EQ(arm->joints[0].actuator->bias[1], -2000);
  EXPECT_DOUBLE_EQ(arm->joints[0].actuator->bias[2], -400);
  EXPECT_DOUBLE_EQ(arm->home[0], -1.5708);
  const Pose home = compose(*arm, as_span(arm->home));
  EXPECT_NEAR((home.p - Eigen::Vector3d(-0.134, 0.492, 0.488)).norm(), 0, 1e-3);
  Rng rng(1);
  EXPECT_LT(worst_chain_error(model, *arm, rng, 200), 1e-12);
}

TEST(FindArm, Panda) {
  const Model model = testing::shipped("panda");
  const auto arm = find_arm(model);
  ASSERT_TRUE(arm) << arm.error().what;
  EXPECT_EQ(arm->dof(), 7);
  EXPECT_EQ(arm->tip, "hand_tcp");
  ASSERT_TRUE(arm->gripper);
  EXPECT_EQ(arm->gripper->drives[0].actuator, "actuator8");
  EXPECT_EQ(arm->gripper->drives[0].id, 7);
  EXPECT_DOUBLE_EQ(arm->gripper->drives[0].ctrl_open, 255);
  EXPECT_DOUBLE_EQ(arm->gripper->drives[0].ctrl_closed, 0);
  EXPECT_EQ(arm->gripper->joints, (std::vector<std::string>{"finger_joint1", "finger_joint2"}));
  EXPECT_DOUBLE_EQ(arm->limits.velocity[6], 2.61);
  EXPECT_DOUBLE_EQ(arm->limits.jerk[1], 3750);
  Rng rng(2);
  EXPECT_LT(worst_chain_error(model, *arm, rng, 200), 1e-12);
  for (const char* tip : {"hand", "panda_link8", "left_finger"}) {
    const auto other = find_arm(model, {.tip = tip});
    ASSERT_TRUE(other) << other.error().what;
    EXPECT_EQ(other->dof(), std::string_view(tip) == "left_finger" ? 8 : 7);
    EXPECT_LT(worst_chain_error(model, *other, rng, 50), 1e-12) << tip;
  }
}

TEST(FindArm, UrdfHasLimitsOfTheFileAndMotors) {
  const auto model = Model::load(find_model_file("universal_robots_ur5e/ur5e.urdf").value());
  ASSERT_TRUE(model) << model.error().what;
  const auto arm = find_arm(*model);
  ASSERT_TRUE(arm) << arm.error().what;
  EXPECT_EQ(arm->tip, "tool0");
  for (int i = 0; i < 6; ++i) {
    EXPECT_TRUE(arm->joints[i].actuator);
    EXPECT_EQ(arm->limits.sources[i].velocity, LimitSource::file);
    EXPECT_EQ(arm->limits.sources[i].torque, LimitSource::file);
    EXPECT_EQ(arm->limits.sources[i].acceleration, LimitSource::table);
  }
  Rng rng(3);
  EXPECT_LT(worst_chain_error(*model, *arm, rng, 100), 1e-12);
}

/// A random chain: hinges and slides about random axes, several on one body, anchors, references,
/// fixed bodies in between, a moved and turned tip; in file order.
std::string random_chain(Rng& rng, int bodies) {
  std::ostringstream xml;
  xml.precision(17);
  const auto vector = [&](int count, double size) {
    std::ostringstream words;
    words.precision(17);
    for (int i = 0; i < count; ++i) words << rng.uniform(-size, size) << ' ';
    return words.str();
  };
  xml << "<mujoco><compiler angle=\"radian\"/><worldbody>";
  for (int b = 0; b < bodies; ++b) {
    xml << "<body pos=\"" << vector(3, 0.5) << "\" quat=\"" << vector(4, 1) << "\">"
        << "<geom size=\".1\"/>";
    const int joints = b == 0 ? 1 : static_cast<int>(rng.below(3));
    for (int j = 0; j < joints; ++j) {
      xml << "<joint type=\"" << (rng.below(3) == 0 ? "slide" : "hinge") << "\" axis=\""
          << vector(3, 1) << "\" pos=\"" << vector(3, 0.3) << "\" ref=\"" << rng.uniform(-2, 2)
          << "\"/>";
    }
  }
  xml << "<site name=\"tip\" pos=\"" << vector(3, 0.3) << "\" euler=\"" << vector(3, 3) << "\"/>";
  for (int b = 0; b < bodies; ++b) xml << "</body>";
  xml << "</worldbody></mujoco>";
  return xml.str();
}

TEST(FindArm, RandomChainsMatchMujoco) {
  Rng rng(7);
  for (int n = 0; n < 200; ++n) {
    const Model model = from_text(random_chain(rng, 1 + static_cast<int>(rng.below(7))));
    const auto arm = find_arm(model, {.tip = "tip"});
    ASSERT_TRUE(arm) << arm.error().what;
    EXPECT_EQ(arm->dof(), model.nq());
    EXPECT_LT(worst_chain_error(model, *arm, rng, 10), 1e-12) << n;
    for (const ArmJoint& joint : arm->joints) EXPECT_NEAR(joint.axis.norm(), 1, 1e-14);
  }
}

TEST(FindArm, FreeBaseStaysWhereTheModelStarts) {
  const Model model =
      from_text(world("<body pos=\"1 2 3\" quat=\"1 0 0 1\"><freejoint/><geom size=\".1\"/>" +
                      serial(3) + "<site name=\"tip\"/>" + close(4)));
  const auto arm = find_arm(model);
  ASSERT_TRUE(arm) << arm.error().what;
  EXPECT_EQ(arm->dof(), 3);
  EXPECT_EQ(arm->joints[0].qpos, 7);
  EXPECT_EQ(arm->joints[0].dof, 6);
  Rng rng(4);
  EXPECT_LT(worst_chain_error(model, *arm, rng, 20), 1e-12);
}

TEST(FindArm, TwoArmsAreAnErrorThatListsTheirTips) {
  const Model model = from_text(
      world(serial(4, "<joint name=\"%j\"/>", "left_") + "<site name=\"left/tcp\"/>" + close(4) +
            serial(4, "<joint name=\"%j\"/>", "right_") + "<site name=\"right/tcp\"/>" + close(4)));
  const auto arm = find_arm(model);
  ASSERT_FALSE(arm);
  EXPECT_EQ(arm.error().code, Errc::usage);
  EXPECT_THAT(arm.error().what, HasSubstr("2 arms"));
  EXPECT_THAT(arm.error().what, HasSubstr("left/tcp, right/tcp"));
  EXPECT_EQ(find_arm(model, {.tip = "right/tcp"}).value().joints[0].name, "right_0j");
}

TEST(FindArm, SeveralTipsAreAnErrorThatListsThem) {
  const Model model =
      from_text(world(serial(4) + "<site name=\"torch\"/><site name=\"camera\"/>" + close(4)));
  const auto arm = find_arm(model);
  ASSERT_FALSE(arm);
  EXPECT_THAT(arm.error().what, HasSubstr("torch, camera"));
  EXPECT_EQ(find_arm(model, {.tip = "camera"}).value().tip, "camera");
}

TEST(FindArm, UsualNamesComeFirst) {
  const Model model = from_text(
      world(serial(4) +
            "<site name=\"camera\"/><site name=\"ee_link\"/><site name=\"attachment_site\"/>" +
            close(4)));
  EXPECT_EQ(find_arm(model).value().tip, "attachment_site");
}

TEST(FindArm, WithoutSitesTheLastBodyIsTheTip) {
  const Model model = from_text(
      world(serial(3) + "<body name=\"flat\"/><body name=\"deep\"><body name=\"deeper\"/></body>" +
            close(3)));
  EXPECT_EQ(find_arm(model).value().tip, "deeper");
  const Model nameless =
      from_text("<mujoco><worldbody><body><joint/><geom size=\".1\"/></body></worldbody></mujoco>");
  EXPECT_EQ(find_arm(nameless).value().tip, "#1");
}

TEST(FindArm, UnknownTipNamesTheNearest) {
  const auto arm = find_arm(testing::shipped("ur5e"), {.tip = "atachment_site"});
  ASSERT_FALSE(arm);
  EXPECT_THAT(arm.error().what, HasSubstr("did you mean \"attachment_site\""));
}

TEST(FindArm, FixedTipAndEmptyModelAreErrors) {
  const auto fixed = find_arm(testing::shipped("ur5e"), {.tip = "base"});
  ASSERT_FALSE(fixed);
  EXPECT_THAT(fixed.error().what, HasSubstr("no joint moves \"base\""));
  const auto none = find_arm(testing::shipped("hello"));
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().what, HasSubstr("there is no arm"));
}

TEST(FindArm, BallJointOnTheWayIsAnErrorThatNamesIt) {
  const Model model = from_text(world(
      serial(3) +
      "<body><joint name=\"socket\" type=\"ball\"/><geom size=\".1\"/><site name=\"tip\"/></body>" +
      close(3)));
  const auto arm = find_arm(model, {.tip = "tip"});
  ASSERT_FALSE(arm);
  EXPECT_THAT(arm.error().what, HasSubstr("\"socket\""));
}

TEST(FindArm, SixteenJointsAreTheMost) {
  EXPECT_EQ(find_arm(from_text(world(serial(16) + close(16)))).value().dof(), 16);
  const auto arm = find_arm(from_text(world(serial(17) + close(17))));
  ASSERT_FALSE(arm);
  EXPECT_THAT(arm.error().what, HasSubstr("17 joints"));
}

TEST(FindArm, DoorsAndFingersAreNoArms) {
  const std::string door = "<body><joint name=\"door\"/><geom size=\".1\"/></body>";
  const std::string hand =
      "<body name=\"thumb\"><joint name=\"t0\"/><geom size=\".1\"/><body><joint name=\"t1\"/><geom "
      "size=\".1\"/></body></body>"
      "<body name=\"index\"><joint name=\"i0\"/><geom size=\".1\"/><body><joint name=\"i1\"/><geom "
      "size=\".1\"/></body></body>";
  const auto arm = find_arm(from_text(world(door + serial(5) + hand + close(5))));
  ASSERT_TRUE(arm) << arm.error().what;
  EXPECT_EQ(arm->dof(), 5);
  EXPECT_EQ(arm->tip, "b4");
}

/// As in Google's robot, whose last joint is called joint_gripper.
TEST(FindArm, AHingeThatTurnsTwoFingersIsTheWristWhateverItsName) {
  const auto finger = [](const std::string& side) {
    return "<body name=\"" + side + "\"><joint name=\"finger_" + side +
           "\"/><geom size=\".01\"/></body>";
  };
  const std::string hand =
      "<body name=\"palm\"><joint name=\"joint_gripper\" axis=\"0 0 1\"/><geom size=\".01\"/>"
      "<site name=\"gripper\"/>" +
      finger("left") + finger("right") + "</body>";
  const auto arm = find_arm(from_text(world(serial(6) + hand + close(6))));
  ASSERT_TRUE(arm) << arm.error().what;
  EXPECT_EQ(arm->dof(), 7);
  EXPECT_EQ(arm->joints.back().name, "joint_gripper");
  EXPECT_EQ(arm->tip, "gripper");
  // A slide between them is part of the gripper.
  const auto slide = find_arm(from_text(
      world(serial(6) + "<body><joint name=\"gripper_base\" type=\"slide\"/><geom size=\".01\"/>" +
            finger("left") + finger("right") + "</body>" + close(6))));
  ASSERT_TRUE(slide) << slide.error().what;
  EXPECT_EQ(slide->dof(), 6);
}

TEST(FindArm, SingleJawIsKnownByItsNameAndOpensAwayFromTheHand) {
  const std::string jaw =
      "<body name=\"moving\" pos=\"0 0 .1\"><joint name=\"Jaw\" axis=\"0 1 0\" limited=\"true\" "
      "range=\"-.2 1.5\"/><geom size=\".01\" pos=\".0 0 .1\"/></body>";
  const auto arm = find_arm(from_text(
      world(serial(5) + "<geom size=\".01\" pos=\"-.01 0 .2\"/><site name=\"grip_point\"/>" + jaw +
                close(5),
            "<actuator><position name=\"jaw\" joint=\"Jaw\" kp=\"10\"/></actuator>")));
  ASSERT_TRUE(arm) << arm.error().what;
  EXPECT_EQ(arm->dof(), 5);
  EXPECT_EQ(arm->tip, "grip_point");
  ASSERT_TRUE(arm->gripper);
  EXPECT_DOUBLE_EQ(arm->gripper->drives[0].ctrl_closed, -0.2);
  EXPECT_DOUBLE_EQ(arm->gripper->drives[0].ctrl_open, 1.5);
}

TEST(FindArm, ActuatorsOfOtherKindsLeaveTheJointWithout) {
  const auto arm = find_arm(from_text(world(serial(5) + close(5), R"(<actuator>
    <motor name="m" joint="0j" gear="50" ctrlrange="-2 3" ctrllimited="true"/>
    <velocity name="v" joint="1j" kv="7"/>
    <general name="g" joint="2j" dyntype="filter" dynprm="1"/>
    <motor joint="3j"/><motor joint="3j"/></actuator>)")));
  ASSERT_TRUE(arm) << arm.error().what;
  ASSERT_TRUE(arm->joints[0].actuator);
  EXPECT_DOUBLE_EQ(arm->joints[0].actuator->gear, 50);
  EXPECT_DOUBLE_EQ(arm->joints[0].actuator->ctrl_upper, 3);
  EXPECT_DOUBLE_EQ(arm->limits.torque[0], 100);  // 2 * gear 50, the weaker direction
  EXPECT_EQ(arm->limits.sources[0].torque, LimitSource::file);
  ASSERT_TRUE(arm->joints[1].actuator);
  EXPECT_DOUBLE_EQ(arm->joints[1].actuator->bias[2], -7);
  EXPECT_TRUE(std::isinf(arm->joints[1].actuator->force_upper));
  EXPECT_FALSE(arm->joints[2].actuator);
  EXPECT_FALSE(arm->joints[3].actuator);
  EXPECT_FALSE(arm->joints[4].actuator);
  EXPECT_EQ(arm->limits.sources[4].torque, LimitSource::standard);
  EXPECT_EQ(name(arm->limits.sources[4].torque), "default");
}

TEST(FindArm, HomeIsTheKeyframeOrTheMiddle) {
  const std::string body =
      serial(2, "<joint name=\"%j\" limited=\"true\" range=\"-1 2\"/>") + close(2);
  EXPECT_DOUBLE_EQ(find_arm(from_text(world(body))).value().home[1], 0.5);
  EXPECT_DOUBLE_EQ(find_arm(from_text(world(body, "<keyframe><key qpos=\".1 .2\"/></keyframe>")))
                       .value()
                       .home[1],
                   0.2);
  EXPECT_DOUBLE_EQ(
      find_arm(
          from_text(world(
              body,
              "<keyframe><key qpos=\".1 .2\"/><key name=\"home\" qpos=\".3 .4\"/></keyframe>")))
          .value()
          .home[1],
      0.4);
  EXPECT_DOUBLE_EQ(
      find_arm(
          from_text(world(body, "<keyframe><key qpos=\".1 .2\"/><key qpos=\".3 .4\"/></keyframe>")))
          .value()
          .home[1],
      0.5);
  EXPECT_DOUBLE_EQ(find_arm(from_text(world(serial(2) + close(2)))).value().home[1], 0);
}

TEST(FramePose, ChecksItsInput) {
  const Model model = testing::shipped("ur5e");
  const std::vector<double> q(6, 0.0);
  EXPECT_TRUE(frame_pose(model, "wrist_3_link", q));
  EXPECT_FALSE(frame_pose(model, "wrist_3_lnk", q));
  const auto wrong = frame_pose(model, "wrist_3_link", std::vector<double>(5, 0.0));
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().what, HasSubstr("5 values, 6 are needed"));
}

}  // namespace
}  // namespace mjarm
