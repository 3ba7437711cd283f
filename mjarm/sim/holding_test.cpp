// Joints that are not the arm's stay where they are, and nothing else does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "mjarm/sim/others_test.hpp"
#include "mjarm/sim/stepper.hpp"
#include "mjarm/sim/worlds_test.hpp"

namespace mjarm {
namespace {

using testing::controller_of;
using testing::load_text;
using testing::Loaded;
using ::testing::Pair;
using testing::robot_with_others;
using testing::small_world;
using ::testing::UnorderedElementsAre;

/// Swings both joints of the arm by up to 0.5 rad, at up to 3 rad/s^2, for `seconds`.
/// @return [m] the largest distance of the tool from where it should be.
double swing(Sim& sim, const Loaded& robot, double seconds) {
  const double h = robot.model.timestep();
  Controller controller = controller_of(robot, ControlMode::computed_torque);
  Stepper stepper(sim, robot.arm);
  const JointVec q0 = sim.arm_state(robot.arm).q;
  const auto at = [&](double t) -> JointVec {
    return q0 + JointVec::Constant(q0.size(), 0.25 * (1 - std::cos(3.5 * std::max(t, 0.0))));
  };
  Sim wanted(robot.model);
  double worst = 0;
  for (int i = 0; i * h < seconds; ++i) {
    const double t = i * h;
    const StepReference reference{at(t - h), at(t), at(t + h)};
    EXPECT_TRUE(stepper.step(sim, controller, reference, nullptr));
    wanted.place(robot.arm, as_span(reference.next));
    worst = std::max(worst, (sim.tool(robot.arm).p - wanted.tool(robot.arm).p).norm());
  }
  return worst;
}

double qpos_of(const Sim& sim, const char* joint, int offset = 0) {
  const mjModel* m = sim.model().raw();
  const int id = mj_name2id(m, mjOBJ_JOINT, joint);
  return sim.qpos()[static_cast<std::size_t>(m->jnt_qposadr[id] + offset)];
}

TEST(Holding, TakesTheJointsOfRobotsAloneThatNothingElseMoves) {
  const Loaded robot = load_text(robot_with_others());
  ASSERT_EQ(robot.arm.dof(), 3) << "mast, shoulder, elbow";
  ASSERT_TRUE(robot.arm.gripper);
  std::map<std::string, bool> driven;
  for (const HeldJoint& joint : held_joints(robot.model, robot.arm)) {
    driven[joint.name] = joint.actuator.has_value();
  }
  EXPECT_THAT(driven,
              UnorderedElementsAre(Pair("base_free", false), Pair("wheel", true),
                                   Pair("tray", false), Pair("second", true), Pair("crane", true)));
  EXPECT_TRUE(
      held_joints(testing::load_shipped("ur5e").model, testing::load_shipped("ur5e").arm).empty());
  EXPECT_TRUE(held_joints(testing::load_shipped("panda").model, testing::load_shipped("panda").arm)
                  .empty());
}

TEST(Holding, OthersStandWhileTheArmMovesAndTheSceneFalls) {
  const Loaded robot = load_text(robot_with_others());
  Sim sim(robot.model), falling(robot.model);
  sim.hold_others(robot.arm);
  const double worst = swing(sim, robot, 2);
  EXPECT_LT(worst, 1e-5);
  ASSERT_EQ(sim.held().size(), 5U);
  for (const HeldState& one : sim.held()) EXPECT_LT(one.moved, 1e-6) << one.joint.name;
  // What is not the robot's goes on as it would without: the cup and the door fall, the flaps hang.
  EXPECT_NEAR(qpos_of(sim, "cup_free", 2), 1 - 9.81 / 2 * 4, 0.05);
  EXPECT_GT(std::abs(qpos_of(sim, "flap")), 0.1);
  EXPECT_GT(std::abs(qpos_of(sim, "chain")), 0.01);
  // Without, the robot falls with its arm.
  EXPECT_GT(swing(falling, robot, 0.5), 0.5);
}

TEST(Holding, GoesOnFromASnapshotToTheLastBit) {
  const Loaded robot = load_text(robot_with_others());
  Sim sim(robot.model);
  sim.hold_others(robot.arm);
  swing(sim, robot, 0.1);
  const Snapshot before = sim.snapshot();
  swing(sim, robot, 0.1);
  const Snapshot after = sim.snapshot();
  ASSERT_TRUE(sim.restore(before));
  swing(sim, robot, 0.1);
  EXPECT_EQ(sim.snapshot().state, after.state);
  EXPECT_EQ(sim.snapshot().place, after.place);
}

TEST(Holding, TellsHowFarAWeakActuatorGaveWay) {
  // A third link beside the arm, with a motor that cannot bear it.
  const std::string beam = R"(<body name="beam" pos="0 1 0.6"><joint name="beam" axis="0 1 0"/>
      <geom type="capsule" fromto="0.05 0 0 0.3 0 0" size="0.03" mass="2"/></body>)";
  std::string text = small_world("integrator=\"implicitfast\"", "400", beam);
  text.insert(text.find("</actuator>"), R"(<motor joint="beam" ctrlrange="-1 1"/>)");
  text.erase(text.find("<keyframe>"), text.find("</keyframe>") + 11 - text.find("<keyframe>"));
  const Loaded robot = load_text(text);
  Sim sim(robot.model);
  sim.hold_others(robot.arm);
  swing(sim, robot, 0.3);
  ASSERT_EQ(sim.held().size(), 1U);
  EXPECT_GT(sim.held().front().moved, 0.1);
}

}  // namespace
}  // namespace mjarm
