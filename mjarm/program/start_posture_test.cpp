#include "mjarm/program/start_posture.hpp"

#include <gtest/gtest.h>

#include "mjarm/collision/exact.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm::program {
namespace {

TEST(StartPosture, HomeIsTakenWhereItIsFit) {
  for (const char* name : {"ur5e", "panda"}) {
    const Robot robot = load_robot(name).value();
    Rng rng(1);
    const auto postures =
        start_postures(robot.arm, ExactChecker(robot.model, robot.arm).predicate(), rng);
    ASSERT_FALSE(postures.empty());
    EXPECT_TRUE(postures[0].is_home) << name;
    EXPECT_EQ(postures[0].q, robot.arm.home);
  }
}

TEST(StartPosture, StretchedHomeGivesWayToBentOnes) {
  Robot robot = load_robot("ur5e").value();
  robot.arm.home.setZero();  // stretched out, a singularity
  EXPECT_LT(dexterity(robot.arm, as_span(robot.arm.home)), 1e-6);
  ExactChecker checker(robot.model, robot.arm);
  Rng rng(1), again(1);
  const auto postures = start_postures(robot.arm, checker.predicate(), rng);
  ASSERT_GE(postures.size(), 5U);
  for (const StartPosture& posture : postures) {
    EXPECT_FALSE(posture.is_home);
    EXPECT_TRUE(within_limits(robot.arm, as_span(posture.q)));
    EXPECT_TRUE(checker.is_free(as_span(posture.q)));
    EXPECT_GT(posture.dexterity, 0.1);
    EXPECT_GT(posture.limit_room, 0.2);
    EXPECT_GT(fk(robot.arm, as_span(posture.q)).p.z(), 0.1);
  }
  const auto same = start_postures(robot.arm, checker.predicate(), again);
  ASSERT_EQ(same.size(), postures.size());
  for (std::size_t i = 0; i < same.size(); ++i) EXPECT_EQ(same[i].q, postures[i].q);
}

/// A servo that cannot be told to go where the arm starts would let go of it.
TEST(StartPosture, IsWhereServosCanBeTold) {
  Robot robot = load_robot("ur5e").value();
  ArmActuator& elbow = *robot.arm.joints[2].actuator;
  elbow.ctrl_lower = -1.5;
  elbow.ctrl_upper = -0.5;  // home has 1.57
  Rng rng(1);
  const auto postures =
      start_postures(robot.arm, ExactChecker(robot.model, robot.arm).predicate(), rng);
  ASSERT_GE(postures.size(), 5U);
  for (const StartPosture& posture : postures) {
    EXPECT_FALSE(posture.is_home);
    EXPECT_GT(posture.q[2], -1.5);
    EXPECT_LT(posture.q[2], -0.5);
  }
}

TEST(StartPosture, NoneWhereAllAreRefused) {
  const Robot robot = load_robot("ur5e").value();
  Rng rng(1);
  const auto nothing = [](std::span<const double>) { return false; };
  EXPECT_TRUE(start_postures(robot.arm, nothing, rng).empty());
}

/// Of fewer than six joints only the tool's place counts: two links in a plane lose a direction
/// everywhere, three that turn on a column lose it stretched.
TEST(StartPosture, FewJointsAreJudgedByPosition) {
  Arm arm = load_robot("ur5e").value().arm;
  arm.joints.resize(3);
  for (JointVec* v : {&arm.limits.lower, &arm.limits.upper, &arm.home}) v->conservativeResize(3);
  arm.X_JT = {{0, 0, 0.4}, Eigen::Matrix3d::Identity()};
  const JointVec stretched = joint_vec(std::vector<double>{0, -1, 0});
  const JointVec bent = joint_vec(std::vector<double>{0, -1, 1.5});
  EXPECT_LT(dexterity(arm, as_span(stretched)), 1e-6);
  EXPECT_GT(dexterity(arm, as_span(bent)), 0.1);
}

}  // namespace
}  // namespace mjarm::program
