#include "mjarm/session/free_sim.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>

#include "mjarm/model/shipped_test.hpp"
#include "mjarm/session/max_moments.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::session {
namespace {

using mjarm::testing::shipped_arm;
using mjarm::testing::TestArm;

std::vector<double> positions(const FreeSim& world) {
  return {world.sim().qpos().begin(), world.sim().qpos().end()};
}

void run(FreeSim& world, int steps) {
  for (int i = 0; i < steps; ++i) world.step();
}

TEST(FreeSim, HoldsTheArmAtHome) {
  for (const char* name : {"ur5e", "panda"}) {
    const TestArm robot = shipped_arm(name);
    FreeSim world = FreeSim::create(robot.model, robot.arm, false).value();
    run(world, 1000);
    const JointVec off = world.sim().arm_state(robot.arm).q - robot.arm.home;
    EXPECT_LT(off.cwiseAbs().maxCoeff(), 1e-3) << name;
  }
}

TEST(FreeSim, PassiveFalls) {
  const TestArm robot = shipped_arm("ur5e");
  FreeSim world = FreeSim::create(robot.model, robot.arm, true).value();
  EXPECT_TRUE(world.jog_dofs().empty());
  run(world, 500);
  const JointVec off = world.sim().arm_state(robot.arm).q - robot.arm.home;
  EXPECT_GT(off.cwiseAbs().maxCoeff(), 0.1);
}

TEST(FreeSim, JogsWithinTheSpeedLimit) {
  const TestArm robot = shipped_arm("ur5e");
  FreeSim world = FreeSim::create(robot.model, robot.arm, false).value();
  const int dof = robot.arm.joints[2].dof;
  ASSERT_EQ(world.jog_dofs().size(), 6U);
  const double goal = robot.arm.home[2] - 0.5;
  world.handle(view::JointEvent{dof, "elbow", goal});
  double fastest = 0;
  for (int i = 0; i < 2000; ++i) {
    world.step();
    fastest = std::max(fastest, std::abs(world.sim().arm_state(robot.arm).v[2]));
  }
  EXPECT_NEAR(world.sim().arm_state(robot.arm).q[2], goal, 2e-3);
  EXPECT_GT(fastest, 0.1);
  EXPECT_LT(fastest, robot.arm.limits.velocity[2]);
  // Beyond the limits it goes to the limit, and what is no joint of the arm is left alone.
  world.handle(view::JointEvent{dof, "elbow", 100});
  world.handle(view::JointEvent{99, "none", 1});
  run(world, 5000);
  EXPECT_LE(world.sim().arm_state(robot.arm).q[2], robot.arm.limits.upper[2] + 1e-2);
}

TEST(FreeSim, StepsBackAndForthAreTheSameToTheLastBit) {
  const TestArm robot = shipped_arm("ur5e");
  FreeSim world = FreeSim::create(robot.model, robot.arm, false).value();
  world.handle(view::JointEvent{robot.arm.joints[0].dof, "pan", 0.3});
  run(world, 40);
  std::vector<Snapshot> seen;
  for (int i = 0; i < 20; ++i) {
    world.step();
    seen.push_back(world.sim().snapshot());
  }
  world.handle(view::PauseEvent{true});
  for (int i = 18; i >= 10; --i) {
    world.handle(view::StepEvent{-1});
    ASSERT_EQ(world.sim().snapshot().state, seen[static_cast<std::size_t>(i)].state);
  }
  world.handle(view::StepEvent{1});
  EXPECT_EQ(world.sim().snapshot().state, seen[11].state);
  // Going on from there gives what came the first time.
  for (std::size_t i = 12; i < seen.size(); ++i) {
    world.step();
    ASSERT_EQ(world.sim().snapshot().state, seen[i].state) << i;
  }
  EXPECT_EQ(world.steps_due(), 0);
  world.handle(view::StepEvent{1});
  EXPECT_EQ(world.steps_due(), 1);
}

TEST(FreeSim, PushesMoveTheArmUntilLetGo) {
  const TestArm robot = shipped_arm("ur5e");
  FreeSim world = FreeSim::create(robot.model, robot.arm, false).value();
  const std::vector<double> before = positions(world);
  const int body = robot.model.raw()->dof_bodyid[robot.arm.joints.back().dof];
  for (int i = 0; i < 300; ++i) {
    world.handle(view::PushEvent{.body = body, .force_W = {60, 0, 0}});
    world.step();
  }
  const std::vector<double> pushed = positions(world);
  double moved = 0;
  for (std::size_t i = 0; i < 6; ++i) moved = std::max(moved, std::abs(pushed[i] - before[i]));
  EXPECT_GT(moved, 1e-3);
  world.handle(view::ReleaseEvent{body});
  run(world, 3000);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(positions(world)[i], before[i], 1e-3);
}

TEST(FreeSim, ResetBeginsAnew) {
  const TestArm robot = shipped_arm("panda");
  FreeSim world = FreeSim::create(robot.model, robot.arm, false).value();
  const Snapshot first = world.sim().snapshot();
  run(world, 30);
  const Snapshot later = world.sim().snapshot();
  world.handle(view::PushEvent{.body = 3, .force_W = {0, 9, 0}});
  run(world, 30);
  world.handle(view::ResetEvent{});
  EXPECT_EQ(world.sim().snapshot().state, first.state);
  run(world, 30);
  EXPECT_EQ(world.sim().snapshot().state, later.state);
}

TEST(FreeSim, AnyModelCanBeLookedAt) {
  const Model model = Model::load(find_model_file("car").value()).value();
  FreeSim world = FreeSim::create(model, std::nullopt, false).value();
  run(world, 10);
  EXPECT_NEAR(world.sim().time(), 10 * model.timestep(), 1e-9);
}

TEST(FreeSim, OneThatBecameUnstableBeginsAnewAndSaysSo) {
  const TestArm robot = shipped_arm("ur5e");
  FreeSim world = FreeSim::create(robot.model, robot.arm, false).value();
  const Snapshot first = world.sim().snapshot();
  world.handle(view::JointEvent{robot.arm.joints[0].dof, "pan", 0.3});
  run(world, 10);
  const int body = robot.model.raw()->dof_bodyid[robot.arm.joints.back().dof];
  for (int i = 0; i < 50 && world.status().empty(); ++i) {
    world.handle(view::PushEvent{.body = body, .force_W = {1e15, 0, 0}});
    world.step();
  }
  EXPECT_THAT(world.status(), ::testing::HasSubstr("unstable"));
  EXPECT_EQ(world.sim().snapshot().state, first.state);
  EXPECT_EQ(world.goal(), robot.arm.home);
  world.handle(view::ReleaseEvent{body});
  run(world, 100);
  EXPECT_LT((world.sim().arm_state(robot.arm).q - robot.arm.home).cwiseAbs().maxCoeff(), 1e-3);
  world.handle(view::ResetEvent{});
  EXPECT_EQ(world.status(), "");
}

TEST(FreeSim, GoalsAreClampedAndOnlyForAnArmThatIsHeld) {
  const TestArm robot = shipped_arm("panda");
  FreeSim world = FreeSim::create(robot.model, robot.arm, false).value();
  JointVec far = robot.arm.home;
  far[3] = -50;
  world.set_goal(far);
  EXPECT_EQ(world.goal()[3], robot.arm.limits.lower[3]);
  EXPECT_EQ(world.goal()[0], robot.arm.home[0]);
  world.set_goal(joint_vec(std::vector<double>{1, 2}));  // of another arm
  EXPECT_EQ(world.goal()[3], robot.arm.limits.lower[3]);
  // On the way there no joint is faster than half its limit.
  for (int i = 0; i < 500; ++i) {
    const JointVec before = world.reference();
    world.step();
    const JointVec v = (world.reference() - before) / robot.model.timestep();
    ASSERT_TRUE((v.cwiseAbs().array() <= 0.5 * robot.arm.limits.velocity.array() + 1e-9).all());
  }

  FreeSim passive = FreeSim::create(robot.model, robot.arm, true).value();
  passive.set_goal(far);
  passive.handle(view::JointEvent{robot.arm.joints[0].dof, "pan", 0.3});
  EXPECT_EQ(passive.goal(), robot.arm.home);
  EXPECT_FALSE(passive.is_held());
}

TEST(FreeSim, AnArmWithoutActuatorsIsOnlyLookedAt) {
  const support::TempFolder folder;
  const Model model = Model::load(folder.write("bare.xml", R"(
<mujoco>
  <worldbody>
    <body name="a"><joint name="pan" axis="0 0 1" range="-3 3"/><geom size="0.05"/>
      <body name="b" pos="0.3 0 0"><joint name="lift" axis="0 1 0" range="-2 2"/><geom size="0.05"/>
        <site name="tip" pos="0.2 0 0"/></body></body>
  </worldbody>
</mujoco>)"))
                          .value();
  const Arm arm = find_arm(model).value();
  const Result<FreeSim> held = FreeSim::create(model, arm, false);
  ASSERT_FALSE(held);
  EXPECT_EQ(held.error().code, Errc::not_available);
  FreeSim passive = FreeSim::create(model, arm, true).value();
  run(passive, 10);
  EXPECT_EQ(passive.status(), "");
}

TEST(MaxMoments, AreBoundedByMemory) {
  const TestArm robot = shipped_arm("ur5e");
  const Sim small(robot.model);
  EXPECT_EQ(max_moments(small, 2000), 2000U);
  const std::size_t numbers = small.snapshot().state.size();
  const std::size_t all = max_moments(small, std::size_t{1} << 40);
  EXPECT_LE(all * numbers * sizeof(double), std::size_t{64} << 20);
  EXPECT_GT((all + 1) * numbers * sizeof(double), std::size_t{64} << 20);
}

}  // namespace
}  // namespace mjarm::session
