// Limits and grippers of arms: which figure counts where several are given, by what a known robot
// is recognised, which way a gripper opens.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <memory>
#include <string>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/gripper_command.hpp"
#include "mjarm/model/limits_table.hpp"
#include "mjarm/model/shipped_test.hpp"

namespace mjarm {
namespace {

/// The same arm with other frames: the base stands elsewhere, and each joint's frame is turned
/// about its axis, moved along it, and given other axes.
Arm with_other_frames(const Arm& arm, Rng& rng) {
  const auto turn = [&rng] {
    return rotation_exp(3 * Eigen::Vector3d(rng.uniform(), rng.uniform(), rng.uniform()));
  };
  Arm other = arm;
  Pose undo = {{rng.normal(), rng.normal(), rng.normal()}, turn()};
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    const Eigen::Vector3d axis = arm.joints[i].axis;
    const Pose along = {rng.uniform(-1, 1) * axis, rotation_exp(rng.uniform(-3, 3) * axis)};
    const Pose own = along * Pose{Eigen::Vector3d::Zero(), turn()};
    other.joints[i].X_PJ = undo * arm.joints[i].X_PJ * own;
    other.joints[i].axis = own.R.transpose() * axis;
    undo = own.inverse();
  }
  return other;
}

TEST(KnownRobots, AreKnownByTheirAxesWhereverTheirFramesSit) {
  Rng rng(71);
  for (const auto& [shipped, known] : {std::pair("ur5e", "UR5e"), std::pair("panda", "Panda")}) {
    const Arm arm = testing::shipped_arm(shipped).arm;
    for (int n = 0; n < 50; ++n) {
      const KnownRobot* robot = known_robot(with_other_frames(arm, rng));
      ASSERT_NE(robot, nullptr) << shipped;
      EXPECT_EQ(robot->name, known);
      EXPECT_EQ(robot->velocity.size(), arm.joints.size());
      EXPECT_EQ(robot->jerk.size(), arm.joints.size());
    }
    Arm backwards = arm;  // axes that point the other way are the same lines
    for (ArmJoint& joint : backwards.joints) joint.axis = -joint.axis;
    EXPECT_NE(known_robot(backwards), nullptr);
  }
}

TEST(KnownRobots, AreNotKnownByAPartOrWithOtherLengths) {
  const Arm arm = testing::shipped_arm("ur5e").arm;
  const auto with = [&arm](auto&& change) {
    Arm other = arm;
    change(other);
    return known_robot(other);
  };
  EXPECT_NE(with([](Arm&) {}), nullptr);
  EXPECT_EQ(with([](Arm& a) { a.joints.pop_back(); }), nullptr);
  EXPECT_EQ(with([](Arm& a) { a.joints.erase(a.joints.begin()); }), nullptr);
  EXPECT_EQ(with([](Arm& a) { a.joints.push_back(a.joints.back()); }), nullptr);
  EXPECT_EQ(with([](Arm& a) { a.joints[3].type = JointType::slide; }), nullptr);
  EXPECT_EQ(with([](Arm& a) { a.joints[0].name = "fr3_joint1"; }), nullptr);
  EXPECT_EQ(with([](Arm& a) { a.joints.clear(); }), nullptr);
  // The upper arm, 0.425 m long, a little longer and too long.
  const Eigen::Vector3d along = arm.joints[2].X_PJ.p.normalized();
  const double length = arm.joints[2].X_PJ.p.norm();
  ASSERT_NEAR(length, 0.425, 0.15);
  EXPECT_NE(with([&](Arm& a) { a.joints[2].X_PJ.p += 0.002 * along; }), nullptr);
  EXPECT_EQ(with([&](Arm& a) { a.joints[2].X_PJ.p += 0.01 * along; }), nullptr);
  EXPECT_EQ(with([](Arm& a) {
              a.joints[4].X_PJ.R = a.joints[4].X_PJ.R * rotation_exp({0.02, 0.02, 0.02});
            }),
            nullptr);
}

/// One hinge "j" and whatever drives it.
Arm driven(const std::string& joint, const std::string& actuators) {
  const auto model = Model::from_mjcf(
      "<mujoco><compiler angle=\"radian\"/><worldbody><body><joint name=\"j\" axis=\"0 1 0\" " +
      joint + "/><geom size=\".1\"/></body></worldbody><actuator>" + actuators +
      "</actuator></mujoco>");
  EXPECT_TRUE(model) << (model ? "" : model.error().what);
  const auto arm = find_arm(*model);
  EXPECT_TRUE(arm) << (arm ? "" : arm.error().what);
  return *arm;
}

TEST(TorqueLimits, TheWeakestOfAllThatActsInEitherDirectionCounts) {
  struct Case {
    const char* joint;
    const char* actuator;
    double torque;
    LimitSource source;
  };
  constexpr LimitSource kFile = LimitSource::file, kStandard = LimitSource::standard;
  for (const Case& c : {
           Case{"", "", 100, kStandard},
           Case{"", "<motor joint=\"j\"/>", 100, kStandard},
           Case{"", "<motor joint=\"j\" ctrlrange=\"-3 2\"/>", 2, kFile},
           Case{"", "<motor joint=\"j\" gear=\"-10\" ctrlrange=\"-3 2\"/>", 20, kFile},
           Case{"", "<motor joint=\"j\" forcerange=\"-4 5\" ctrlrange=\"-9 9\"/>", 4, kFile},
           Case{"actuatorfrcrange=\"-7 6\"", "", 6, kFile},
           Case{"actuatorfrcrange=\"-7 6\"", "<motor joint=\"j\" forcerange=\"-5 5\"/>", 5, kFile},
           Case{"actuatorfrcrange=\"-1 1\"", "<motor joint=\"j\" gear=\"50\" forcerange=\"-5 5\"/>",
                1, kFile},
           // The commands of a servo are angles and no torques.
           Case{"", "<position joint=\"j\" kp=\"10\" ctrlrange=\"-1 1\"/>", 100, kStandard},
           Case{"", "<position joint=\"j\" kp=\"10\" forcerange=\"-30 40\"/>", 30, kFile},
           // Nothing at all would be no limit but an arm that cannot move.
           Case{"", "<motor joint=\"j\" ctrlrange=\"0 5\"/>", 100, kStandard},
       }) {
    const Arm arm = driven(c.joint, c.actuator);
    EXPECT_DOUBLE_EQ(arm.limits.torque[0], c.torque) << c.joint << c.actuator;
    EXPECT_EQ(arm.limits.sources[0].torque, c.source) << c.joint << c.actuator;
    EXPECT_EQ(arm.limits.sources[0].velocity, LimitSource::standard);
    EXPECT_TRUE(std::isinf(arm.limits.upper[0]));
    EXPECT_EQ(arm.home[0], 0);
  }
}

TEST(TorqueLimits, WhatTheArmSaysOfItsDriveIsWhatMujocoDoes) {
  Rng rng(72);
  for (const std::string drive :
       {"<motor joint=\"j\" gear=\"-3\" ctrlrange=\"-2 2\"/>",
        "<position joint=\"j\" kp=\"20\" kv=\"2\" gear=\"2\" forcerange=\"-9 7\"/>",
        "<velocity joint=\"j\" kv=\"3\" ctrlrange=\"-1 1\"/>",
        "<general joint=\"j\" biastype=\"affine\" gainprm=\"-4\" biasprm=\"1 2 -3\"/>"}) {
    const std::string xml =
        "<mujoco><worldbody><body><joint name=\"j\" axis=\"0 1 0\"/><geom size=\".1\"/></body>"
        "</worldbody><actuator>" +
        drive + "</actuator></mujoco>";
    const Model model = Model::from_mjcf(xml).value();
    const Arm arm = find_arm(model).value();
    ASSERT_TRUE(arm.joints[0].actuator) << drive;
    const ArmActuator& a = *arm.joints[0].actuator;
    const std::unique_ptr<mjData, void (*)(mjData*)> d(mj_makeData(model.raw()), mj_deleteData);
    for (int n = 0; n < 100; ++n) {
      const double q = rng.uniform(-2, 2), v = rng.uniform(-2, 2), ctrl = rng.uniform(-3, 3);
      d->qpos[0] = q;
      d->qvel[0] = v;
      d->ctrl[a.id] = ctrl;
      mj_forward(model.raw(), d.get());
      const double force = a.gain * std::clamp(ctrl, a.ctrl_lower, a.ctrl_upper) + a.bias[0] +
                           a.bias[1] * a.gear * q + a.bias[2] * a.gear * v;
      EXPECT_NEAR(d->qfrc_actuator[0], a.gear * std::clamp(force, a.force_lower, a.force_upper),
                  1e-9)
          << drive;
    }
  }
}

/// An arm of three hinges with two fingers on slides that come from both sides.
std::string with_fingers(const std::string& fingers, const std::string& rest) {
  return R"(<mujoco><compiler angle="radian"/><option gravity="0 0 0"/>
  <default><geom contype="0" conaffinity="0"/></default><worldbody>
  <body><joint axis="0 0 1"/><geom size=".05"/><body pos="0 0 .3"><joint axis="0 1 0"/>
  <geom size=".05"/><body name="hand" pos="0 0 .3"><joint axis="1 0 0"/><geom size=".05"/>)" +
         fingers + "</body></body></body></worldbody>" + rest + "</mujoco>";
}

constexpr const char* kFingers = R"(
  <body name="left" pos=".05 0 .1"><joint name="finger1" type="slide" axis="1 0 0"
    range="-.04 0" damping="5"/><geom size=".01"/></body>
  <body name="right" pos="-.05 0 .1"><joint name="finger2" type="slide" axis="-1 0 0"
    range="-.04 0" damping="5"/><geom size=".01"/></body>)";
constexpr const char* kTendon = R"(<tendon><fixed name="both"><joint joint="finger1" coef=".5"/>
  <joint joint="finger2" coef=".5"/></fixed></tendon>
  <equality><joint joint1="finger1" joint2="finger2"/></equality>)";

/// How far the fingers are apart once they have come to rest under a command, 0 to open and 1 to
/// close [m].
double distance_under(const Model& model, const Gripper& gripper, double grip) {
  const mjModel* m = model.raw();
  const std::unique_ptr<mjData, void (*)(mjData*)> d(mj_makeData(m), mj_deleteData);
  set_grip(gripper, grip, {d->ctrl, static_cast<std::size_t>(m->nu)});
  for (int i = 0; i < 1500; ++i) mj_step(m, d.get());
  const auto at = [&](const char* body) {
    return Eigen::Vector3d(d->xpos + 3 * mj_name2id(m, mjOBJ_BODY, body));
  };
  return (at("left") - at("right")).norm();
}

TEST(Grippers, OpenIsWhereTheFingersAreApartOnceSimulated) {
  for (const std::string drive :
       {"<position name=\"g\" tendon=\"both\" kp=\"200\" ctrlrange=\"-.04 0\"/>",
        "<position name=\"g\" tendon=\"both\" kp=\"200\"/>",
        "<position name=\"g\" tendon=\"both\" kp=\"200\" gear=\"-1\" ctrlrange=\"0 .04\"/>",
        "<motor name=\"g\" tendon=\"both\" ctrlrange=\"-.3 .3\"/>",
        "<motor name=\"g\" tendon=\"both\" gear=\"-1\" ctrlrange=\"-.3 .3\"/>",
        "<general name=\"g\" tendon=\"both\" biastype=\"affine\" gainprm=\".032\" "
        "biasprm=\"-8 -200 0\" ctrlrange=\"0 255\"/>"}) {
    const auto model =
        Model::from_mjcf(with_fingers(kFingers, kTendon + ("<actuator>" + drive + "</actuator>")));
    ASSERT_TRUE(model) << model.error().what;
    const auto arm = find_arm(*model);
    ASSERT_TRUE(arm) << arm.error().what;
    EXPECT_EQ(arm->dof(), 3);
    ASSERT_TRUE(arm->gripper) << drive;
    EXPECT_EQ(arm->gripper->drives[0].actuator, "g");
    EXPECT_EQ(arm->gripper->joints, (std::vector<std::string>{"finger1", "finger2"}));
    EXPECT_EQ(arm->gripper->drives.size(), 1U);
    EXPECT_NEAR(distance_under(*model, *arm->gripper, 0), 0.1, 0.005) << drive;
    EXPECT_NEAR(distance_under(*model, *arm->gripper, 1), 0.02, 0.005) << drive;
  }
}

TEST(Grippers, ADriveForEachFingerOpensAsItsFingerDoes) {
  // The second finger's axis turned round: one opens upwards, the other one downwards.
  std::string turned = kFingers;
  turned.replace(turned.find("axis=\"-1 0 0\""), 13, "axis=\"1 0 0\"");
  turned.replace(turned.rfind("range=\"-.04 0\""), 14, "range=\"0 .04\"");
  for (const auto& [fingers, second] :
       {std::pair(std::string(kFingers), "-.04 0"), std::pair(turned, "0 .04")}) {
    for (const std::string gear : {"1", "-1"}) {
      const std::string range = gear == "1" ? second : second[0] == '-' ? "0 .04" : "-.04 0";
      const std::string drives =
          "<actuator><position name=\"a\" joint=\"finger1\" kp=\"200\" ctrlrange=\"-.04 0\"/>"
          "<position name=\"b\" joint=\"finger2\" kp=\"200\" gear=\"" +
          gear + "\" ctrlrange=\"" + range + "\"/></actuator>";
      const auto model = Model::from_mjcf(with_fingers(fingers, drives));
      ASSERT_TRUE(model) << model.error().what;
      const auto arm = find_arm(*model);
      ASSERT_TRUE(arm) << arm.error().what;
      EXPECT_EQ(arm->dof(), 3);
      ASSERT_TRUE(arm->gripper) << drives;
      ASSERT_EQ(arm->gripper->drives.size(), 2U);
      EXPECT_EQ(arm->gripper->drives[1].actuator, "b");
      EXPECT_EQ(arm->gripper->joints, (std::vector<std::string>{"finger1", "finger2"}));
      EXPECT_NEAR(distance_under(*model, *arm->gripper, 0), 0.1, 0.005) << drives;
      EXPECT_NEAR(distance_under(*model, *arm->gripper, 1), 0.02, 0.005) << drives;
    }
  }
}

TEST(Grippers, WhatOpensAndClosesInNoOneWayIsNone) {
  const std::string motor = "<motor joint=\"finger1\" ctrlrange=\"-1 1\"/>";
  for (const std::string& rest :
       {std::string(), "<actuator>" + motor + motor + "</actuator>",
        "<actuator>" + motor + "<motor joint=\"finger2\"/></actuator>",
        kTendon + std::string("<actuator><motor tendon=\"both\"/></actuator>"),
        kTendon + std::string("<actuator><velocity tendon=\"both\" kv=\"1\"/></actuator>")}) {
    const auto model = Model::from_mjcf(with_fingers(kFingers, rest));
    ASSERT_TRUE(model) << model.error().what;
    const auto arm = find_arm(*model);
    ASSERT_TRUE(arm) << arm.error().what;
    EXPECT_EQ(arm->dof(), 3) << rest;
    EXPECT_FALSE(arm->gripper) << rest;
  }
}

}  // namespace
}  // namespace mjarm
