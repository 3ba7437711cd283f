#include "mjarm/path/tool_target.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/shipped_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using mjarm::testing::shipped_arm;
using mjarm::testing::TestArm;
using ::testing::HasSubstr;
using ::testing::StartsWith;
/// An arm of three joints on a table.
TestArm short_arm() {
  const support::TempFolder folder;
  Model model = Model::load(folder.write("short.xml", R"(
<mujoco>
  <compiler angle="radian"/>
  <worldbody>
    <body name="a" pos="0 0 0.2"><joint name="pan" axis="0 0 1" range="-3 3"/>
      <geom type="capsule" fromto="0 0 0 0 0 0.2" size="0.03"/>
      <body name="b" pos="0 0 0.2"><joint name="lift" axis="0 1 0" range="-2 2"/>
        <geom type="capsule" fromto="0 0 0 0.4 0 0" size="0.02"/>
        <body name="c" pos="0.4 0 0"><joint name="elbow" axis="0 1 0" range="-2 2"/>
          <geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.02"/>
          <site name="tip" pos="0.3 0 0"/>
        </body>
      </body>
    </body>
  </worldbody>
  <keyframe><key name="home" qpos="0 -0.6 1.2"/></keyframe>
</mujoco>)"))
                    .value();
  Arm arm = find_arm(model).value();
  return {std::move(model), std::move(arm)};
}

void expect_same(const Pose& a, const Pose& b, double tolerance = 1e-6) {
  EXPECT_LT((a.p - b.p).norm(), tolerance);
  EXPECT_LT(angle_between(a.R, b.R), tolerance);
}

double largest(const JointVec& q) { return q.cwiseAbs().maxCoeff(); }

Pose moved(Pose pose, const Eigen::Vector3d& way) {
  pose.p += way;
  return pose;
}

TEST(ToolTarget, BeginsWellAtHome) {
  for (const char* name : {"ur5e", "panda"}) {
    const TestArm robot = shipped_arm(name);
    const ToolTarget target(robot.model, robot.arm);
    EXPECT_EQ(target.goal(), robot.arm.home);
    expect_same(target.pose(), fk(robot.arm, as_span(robot.arm.home)));
    EXPECT_EQ(target.grade(), TargetGrade::good) << target.line();
    EXPECT_THAT(target.line(), StartsWith("reachable; "));
  }
}

TEST(ToolTarget, WithoutAModelContactDoesNotCount) {
  const TestArm robot = shipped_arm("ur5e");
  const IkSolver judge(robot.arm);
  Rng rng(7);
  int touching = 0;
  for (int i = 0; i < 100; ++i) {
    ToolTarget target(robot.arm);
    ToolTarget careful(robot.model, robot.arm);
    const Eigen::Vector3d p(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(0, 1.2));
    const Pose X_WT{p, rotation_exp({rng.uniform(-2, 2), 0, rng.uniform(-2, 2)})};
    target.move_to(X_WT);
    careful.move_to(X_WT);
    const bool has_answer = judge.solve(X_WT, as_span(robot.arm.home)).has_value();
    ASSERT_EQ(target.grade() != TargetGrade::unreachable, has_answer) << target.line();
    touching += has_answer && careful.failure() ? 1 : 0;
  }
  EXPECT_GT(touching, 0);
}

/// The arm's solver from home is the judge; it knows nothing of ways.
TEST(ToolTarget, RandomPosesAgreeWithTheSolver) {
  const TestArm robot = shipped_arm("ur5e");
  ExactChecker checker(robot.model, robot.arm);
  const IkSolver judge(robot.arm, {.valid = checker.predicate()});
  Rng rng(7);
  int reached = 0, jumps = 0, refused = 0, touching = 0;
  for (int i = 0; i < 300; ++i) {
    ToolTarget target(robot.model, robot.arm);
    const Eigen::Vector3d p(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(0, 1.2));
    const Eigen::Vector3d turn(rng.uniform(-2, 2), rng.uniform(-2, 2), rng.uniform(-2, 2));
    const Pose X_WT{p, rotation_exp(turn)};
    target.move_to(X_WT);
    expect_same(target.pose(), X_WT, 1e-12);
    const auto answer = judge.solve(X_WT, as_span(robot.arm.home));
    ASSERT_EQ(target.grade() != TargetGrade::unreachable, answer.has_value()) << target.line();
    EXPECT_TRUE(checker.is_free(as_span(target.goal())));
    if (target.is_reached()) {
      ++reached;
      expect_same(fk(robot.arm, as_span(target.goal())), X_WT);
    } else if (target.jump()) {
      ++jumps;
      expect_same(fk(robot.arm, as_span(*target.jump())), X_WT);
      EXPECT_THAT(target.line(), HasSubstr("jump"));
    } else {
      ++refused;
      ASSERT_TRUE(target.failure());
      EXPECT_EQ(target.failure()->code, answer.error().code);
      EXPECT_THAT(target.line(), StartsWith("not reachable: "));
      if (target.failure()->code != IkErrc::collision) continue;
      EXPECT_THAT(target.line(), HasSubstr("overlaps"));
      ++touching;
    }
  }
  EXPECT_GT(reached, 20);
  EXPECT_GT(jumps, 20);
  EXPECT_GT(refused, 20);
  EXPECT_GT(touching, 0);
}

TEST(ToolTarget, ALineOutOfTheWorkspaceStopsAtItsEdge) {
  for (const char* name : {"ur5e", "panda"}) {
    for (const double step : {0.02, 2.0}) {
      const TestArm robot = shipped_arm(name);
      const IkSolver judge(robot.arm);
      ToolTarget target(robot.model, robot.arm);
      const Pose X_home = target.pose();
      const Eigen::Vector3d out = (X_home.p - Eigen::Vector3d(0, 0, 0.3)).normalized();
      for (double way = step; way <= 2; way += step) target.move_to(moved(X_home, way * out));
      EXPECT_EQ(target.grade(), TargetGrade::unreachable);
      ASSERT_TRUE(target.failure());
      EXPECT_EQ(target.failure()->code, IkErrc::out_of_reach) << name << step;
      EXPECT_THAT(target.line(), HasSubstr("out of reach"));
      // On the line, where one can still be and 3 mm further one cannot.
      const Pose X_edge = fk(robot.arm, as_span(target.goal()));
      const double way = (X_edge.p - X_home.p).dot(out);
      EXPECT_GT(way, 0.05);
      expect_same(X_edge, moved(X_home, way * out));
      EXPECT_FALSE(judge.solve(moved(X_edge, 3e-3 * out), as_span(target.goal()))) << name << step;
      // And back, as good as it was.
      target.move_to(X_home);
      EXPECT_EQ(target.grade(), TargetGrade::good) << target.line();
      expect_same(fk(robot.arm, as_span(target.goal())), X_home);
    }
  }
}

/// No joint moves far between neighbours unless it is said, wherever a random walk goes.
TEST(ToolTarget, NeighboursDoNotJump) {
  for (const char* name : {"ur5e", "panda"}) {
    const TestArm robot = shipped_arm(name);
    ToolTarget target(robot.model, robot.arm);
    Rng rng(11);
    Eigen::Vector3d speed(0, 0, 0), turning(0, 0, 0);
    int reached = 0, turned = 0;
    for (int i = 0; i < 1500; ++i) {
      const auto noise = [&] {
        return Eigen::Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
      };
      speed = 0.9 * speed + 0.002 * noise() - 2e-4 * target.pose().p;
      turning = 0.9 * turning + 0.01 * noise();
      const bool before = target.is_reached();
      const JointVec q = target.goal();
      Pose X_WT = moved(target.pose(), speed);
      X_WT.R = rotation_exp(turning) * X_WT.R;
      target.move_to(X_WT);
      if (before && target.is_reached()) {
        ASSERT_LT(largest(target.goal() - q), 0.71) << name << " step " << i;
        ++reached;
      }
      const Pose X_goal = fk(robot.arm, as_span(target.goal()));
      if (target.is_reached()) {
        expect_same(X_goal, X_WT);
      } else {
        // No way on: back to where the tool can be, and elsewhere.
        target.set_goal(q);
        speed = -speed;
        turning = -turning;
        ++turned;
      }
    }
    EXPECT_GT(turned, 0) << name;
    EXPECT_GT(reached, 1000) << name;
  }
}

/// Beyond the last winding of the wrist the pose needs another branch: that is said, not done.
TEST(ToolTarget, AJumpIsShownAndTakenOnlyWhenAsked) {
  const TestArm robot = shipped_arm("ur5e");
  ToolTarget target(robot.model, robot.arm);
  JointVec q = robot.arm.home;
  q[5] = robot.arm.limits.upper[5] - 0.05;
  target.set_goal(q);
  EXPECT_EQ(target.grade(), TargetGrade::near_limit);
  EXPECT_THAT(target.line(), HasSubstr("0.050 rad to that of wrist_3_joint"));
  const Pose X_near = target.pose();
  const auto turned = [&](double angle) {
    Pose X_WT = X_near;
    X_WT.R = X_WT.R * rotation_exp({0, 0, angle});
    return X_WT;
  };
  target.move_to(turned(0.2));
  ASSERT_EQ(target.grade(), TargetGrade::jump) << target.line();
  EXPECT_LT(largest(target.goal() - q), 0.051);
  ASSERT_TRUE(target.jump());
  int joint = 0;
  EXPECT_GT((*target.jump() - target.goal()).cwiseAbs().maxCoeff(&joint), 1);
  EXPECT_THAT(target.line(), HasSubstr(robot.arm.joints[static_cast<std::size_t>(joint)].name));
  target.take_jump();
  EXPECT_TRUE(target.is_reached());
  expect_same(fk(robot.arm, as_span(target.goal())), turned(0.2));
  EXPECT_FALSE(target.jump());
}

/// Each reaches the target, none is another, the goal is the first; one that is taken is the goal.
TEST(ToolTarget, PosturesAllReachTheTargetAndAreTaken) {
  for (const char* name : {"ur5e", "panda"}) {
    const TestArm robot = shipped_arm(name);
    ToolTarget target(robot.model, robot.arm);
    target.move_to(moved(target.pose(), {0.02, 0.03, -0.05}));
    const std::vector<JointVec> postures = target.postures(8);
    ASSERT_GE(postures.size(), 3U) << name;
    EXPECT_LT(largest(postures.front() - target.goal()), 1e-6);
    for (std::size_t i = 0; i < postures.size(); ++i) {
      expect_same(fk(robot.arm, as_span(postures[i])), target.pose());
      for (std::size_t j = 0; j < i; ++j) EXPECT_GT(largest(postures[i] - postures[j]), 1e-3);
    }
    EXPECT_EQ(target.postures(2).size(), 2U);
    target.take_posture(postures.back());
    EXPECT_TRUE(target.is_reached());
    EXPECT_EQ(target.goal(), postures.back());
  }
}

TEST(ToolTarget, OutOfReachThereAreNoPostures) {
  const TestArm robot = shipped_arm("ur5e");
  ToolTarget target(robot.model, robot.arm);
  target.move_to(moved(target.pose(), {3, 0, 0}));
  EXPECT_TRUE(target.postures(8).empty());
}

TEST(ToolTarget, ANearSingularityIsSaid) {
  const TestArm robot = shipped_arm("ur5e");
  ToolTarget target(robot.model, robot.arm);
  JointVec q = robot.arm.home;
  q[4] = 0.004;
  target.set_goal(q);
  EXPECT_EQ(target.grade(), TargetGrade::near_singular);
  EXPECT_THAT(target.line(), HasSubstr("wrist"));
}

TEST(ToolTarget, JogsAlongTheAxesOfTheFrame) {
  for (const char* name : {"ur5e", "panda"}) {
    const TestArm robot = shipped_arm(name);
    for (const JogFrame frame : {JogFrame::world, JogFrame::tool, JogFrame::base}) {
      ToolTarget target(robot.model, robot.arm);
      for (int axis = 0; axis < 6; ++axis) {
        const Pose before = fk(robot.arm, as_span(target.goal()));
        Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
        if (frame == JogFrame::tool) R = before.R;
        // Menagerie's UR5e stands turned by half a turn in its world.
        if (frame == JogFrame::base && robot.arm.name.starts_with("ur5e")) {
          R.diagonal() << -1, -1, 1;
        }
        const double amount = axis < 3 ? 0.02 : -0.05;
        ASSERT_TRUE(target.jog(frame, axis, amount)) << target.line();
        const Pose after = fk(robot.arm, as_span(target.goal()));
        const Eigen::Vector3d along = amount * R.col(axis % 3);
        Pose expected = before;
        if (axis < 3) {
          expected.p += along;
        } else {
          expected.R = rotation_exp(along) * before.R;
        }
        expect_same(after, expected);
        expect_same(target.pose(), expected);
      }
    }
  }
}

TEST(ToolTarget, AJogThatCannotBeLeavesTheTarget) {
  const TestArm robot = shipped_arm("ur5e");
  ToolTarget target(robot.model, robot.arm);
  Pose before = target.pose();
  JointVec goal = target.goal();
  int done = 0;
  while (done < 100 && target.jog(JogFrame::world, 1, 0.05)) {
    before = target.pose();
    goal = target.goal();
    ++done;
  }
  EXPECT_GT(done, 2);
  EXPECT_LT(done, 30);
  EXPECT_THAT(target.line(), StartsWith("the target stays: not reachable: "));
  expect_same(target.pose(), before, 1e-12);
  EXPECT_EQ(target.goal(), goal);
  EXPECT_TRUE(target.jog(JogFrame::world, 1, -0.05));
  EXPECT_THAT(target.line(), ::testing::Not(HasSubstr("stays")));
}

/// After a drag out of reach, whose goal stays at the edge, every jog that leads back is taken, as
/// far as it was asked for.
TEST(ToolTarget, AJogAfterADragOutOfReachBeginsAtTheTool) {
  const TestArm robot = shipped_arm("ur5e");
  ToolTarget target(robot.model, robot.arm);
  target.move_to(moved(target.pose(), {0, 3, 0}));
  ASSERT_EQ(target.grade(), TargetGrade::unreachable);
  const Pose far = target.pose();
  const Pose edge = fk(robot.arm, as_span(target.goal()));
  EXPECT_FALSE(target.jog(JogFrame::world, 1, 0.05));
  expect_same(target.pose(), far, 1e-12);
  expect_same(fk(robot.arm, as_span(target.goal())), edge, 1e-12);
  EXPECT_TRUE(target.jog(JogFrame::world, 1, -0.05)) << target.line();
  EXPECT_TRUE(target.is_reached());
  expect_same(target.pose(), moved(edge, {0, -0.05, 0}));
  expect_same(fk(robot.arm, as_span(target.goal())), target.pose());
}

TEST(ToolTarget, AJumpTakenAfterARefusedJogIsAllThatTheLineTells) {
  const TestArm robot = shipped_arm("ur5e");
  ToolTarget target(robot.model, robot.arm);
  JointVec q = robot.arm.home;
  q[5] = robot.arm.limits.upper[5] - 0.05;
  target.set_goal(q);
  Pose turned = target.pose();
  turned.R = turned.R * rotation_exp({0, 0, 0.2});
  target.move_to(turned);
  ASSERT_EQ(target.grade(), TargetGrade::jump);
  ASSERT_FALSE(target.jog(JogFrame::world, 1, 5));
  EXPECT_THAT(target.line(), StartsWith("the target stays"));
  ASSERT_EQ(target.grade(), TargetGrade::jump);
  target.take_jump();
  EXPECT_TRUE(target.is_reached());
  EXPECT_THAT(target.line(), StartsWith("reachable"));
}

/// An arm of three joints near the limit of its second one has only the other elbow beyond.
TEST(ToolTarget, AJumpOfFewJointsTurnsTheTargetWithTheTool) {
  const TestArm robot = short_arm();
  ToolTarget target(robot.model, robot.arm);
  target.set_goal(joint_vec(std::vector<double>{0, 1.95, -0.6}));
  const JointVec beyond = joint_vec(std::vector<double>{0, 2.1, -0.6});
  target.move_to({fk(robot.arm, as_span(beyond)).p, Eigen::Matrix3d::Identity()});
  ASSERT_EQ(target.grade(), TargetGrade::jump) << target.line();
  target.take_jump();
  ASSERT_TRUE(target.is_reached());
  EXPECT_GT(target.goal()[2], 0.5);
  expect_same(target.pose(), fk(robot.arm, as_span(target.goal())));
}

TEST(ToolTarget, FewJointsTakeThePositionAlone) {
  const TestArm robot = short_arm();
  ToolTarget target(robot.model, robot.arm);
  EXPECT_FALSE(target.turns());
  EXPECT_TRUE(ToolTarget(shipped_arm("ur5e").model, shipped_arm("ur5e").arm).turns());
  const Pose asked{target.pose().p + Eigen::Vector3d(-0.05, 0.1, 0.05),
                   rotation_exp({0.3, 0.2, 1})};
  target.move_to(asked);
  ASSERT_TRUE(target.is_reached()) << target.line();
  const Pose got = fk(robot.arm, as_span(target.goal()));
  EXPECT_LT((got.p - asked.p).norm(), 1e-6);
  expect_same(target.pose(), {asked.p, got.R});
  target.move_to(moved(got, {2, 0, 0}));
  EXPECT_EQ(target.failure()->code, IkErrc::out_of_reach);
}

TEST(ToolTarget, LinesAreAsciiInTheWindowAndChineseElsewhere) {
  const TestArm robot = shipped_arm("ur5e");
  ToolTarget target(robot.model, robot.arm);
  const auto check = [&] {
    for (const char c : target.line()) EXPECT_TRUE(c >= 32 && c < 127) << target.line();
    const LanguageScope scope(Language::chinese);
    EXPECT_THAT(target.line(), HasSubstr("达"));
  };
  check();
  target.move_to(moved(target.pose(), {3, 0, 0}));
  check();
}

}  // namespace
}  // namespace mjarm
