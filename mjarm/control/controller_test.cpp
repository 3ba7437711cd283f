#include "mjarm/control/controller.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mjarm/control/robots_test.hpp"
#include "mjarm/control/sag.hpp"
#include "mjarm/control/world_test.hpp"

namespace mjarm {
namespace {

using testing::controller_of;
using ::testing::HasSubstr;
using testing::load_shipped;
using testing::load_text;
using testing::Loaded;
using testing::odd_arm;
using testing::World;
using testing::worst_tracking_error;

/// Joint errors after standing at home for a while.
JointVec static_error(const Loaded& robot, ControlMode mode) {
  Controller controller = controller_of(robot, mode);
  World world(robot, robot.arm.home);
  for (int i = 0; i < 3000; ++i) world.step(controller, hold(as_span(robot.arm.home)));
  return robot.arm.home - world.q();
}

TEST(StepReference, SecondDifferenceIsWhatSemiImplicitEulerNeeds) {
  const double h = 0.01;
  const StepReference reference{JointVec::Constant(1, 1.0), JointVec::Constant(1, 1.2),
                                JointVec::Constant(1, 1.5)};
  const double v = reference.velocity(h)[0] + h * reference.acceleration(h)[0];
  EXPECT_NEAR(reference.now[0] + h * v, 1.5, 1e-14);
  const JointVec q = JointVec::Constant(3, 0.7);
  EXPECT_EQ(hold(as_span(q)).velocity(h), JointVec::Zero(3));
  EXPECT_EQ(hold(as_span(q)).acceleration(h), JointVec::Zero(3));
}

TEST(Controller, ComputedTorqueTracksToRounding) {
  EXPECT_LT(worst_tracking_error(load_shipped("ur5e"), ControlMode::computed_torque), 1e-9);
  EXPECT_LT(worst_tracking_error(load_text(odd_arm("integrator=\"implicit\"")),
                                 ControlMode::computed_torque),
            1e-9);
}

TEST(Controller, ComputedTorqueTracksWithFingersOnTheArm) {
  EXPECT_LT(worst_tracking_error(load_shipped("panda"), ControlMode::computed_torque), 1e-5);
}

TEST(Controller, ServoLagsBehindAMovingReference) {
  EXPECT_GT(worst_tracking_error(load_shipped("ur5e"), ControlMode::servo), 0.01);
}

TEST(Controller, StaticErrorIsTheSagOfTheServoAndNothingElse) {
  const Loaded robot = load_shipped("ur5e");
  const JointVec sag = static_error(robot, ControlMode::servo);
  EXPECT_GT(sag.cwiseAbs().maxCoeff(), 1e-3);
  World world(robot, robot.arm.home - sag);
  const JointVec expected = static_sag(
      robot.model, robot.arm, {world.d().qpos, static_cast<std::size_t>(robot.model.nq())});
  EXPECT_LT((sag - expected).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT(static_error(robot, ControlMode::servo_gravity).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT(static_error(robot, ControlMode::computed_torque).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Controller, ComputedTorqueComesBackFromAnErrorWithoutOvershoot) {
  const Loaded robot = load_shipped("ur5e");
  Controller controller = controller_of(robot, ControlMode::computed_torque);
  World world(robot, robot.arm.home + JointVec::Constant(6, 0.02));
  for (int i = 0; i < 250; ++i) {
    world.step(controller, hold(as_span(robot.arm.home)));
    EXPECT_GT((world.q() - robot.arm.home).minCoeff(), -1e-4) << "step " << i;
  }
  EXPECT_LT((world.q() - robot.arm.home).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(Controller, SaysWhenALimitCutsTheCommand) {
  const Loaded robot = load_shipped("ur5e");
  for (const ControlMode mode : {ControlMode::servo, ControlMode::computed_torque}) {
    Controller controller = controller_of(robot, mode);
    World world(robot, robot.arm.home);
    EXPECT_FALSE(world.step(controller, hold(as_span(robot.arm.home)))) << name(mode);
    const JointVec far = robot.arm.home + JointVec::Constant(6, 2.0);
    EXPECT_TRUE(world.step(controller, hold(as_span(far)))) << name(mode);
  }
}

TEST(Controller, KnowsTheForceLimitOfTheJointItself) {
  std::string mjcf = odd_arm("integrator=\"Euler\"");
  const std::string joint = "<joint name=\"third\"";
  mjcf.replace(mjcf.find(joint), joint.size(), joint + " actuatorfrcrange=\"-1 2\"");
  const Loaded robot = load_text(mjcf);
  EXPECT_DOUBLE_EQ(robot.arm.joints[2].actuator->force_lower, -0.4) << "the gear is -5";
  EXPECT_DOUBLE_EQ(robot.arm.joints[2].actuator->force_upper, 0.2);
  Controller controller = controller_of(robot, ControlMode::computed_torque);
  World world(robot, robot.arm.home);
  const JointVec far = robot.arm.home + JointVec::Constant(3, 0.5);
  EXPECT_TRUE(world.step(controller, hold(as_span(far))));
}

TEST(Controller, KeepsCtrlWithinItsRangeAndLeavesOthersAlone) {
  const Loaded robot = load_shipped("panda");
  Controller controller = controller_of(robot, ControlMode::servo);
  std::vector<double> ctrl(robot.model.nu(), 123.0);
  const std::vector<double> qpos(robot.model.qpos0().begin(), robot.model.qpos0().end());
  const std::vector<double> qvel(robot.model.nv(), 0.0);
  const JointVec far = JointVec::Constant(robot.arm.dof(), 50.0);
  EXPECT_TRUE(controller.command(qpos, qvel, hold(as_span(far)), ctrl));
  for (const ArmJoint& joint : robot.arm.joints) {
    EXPECT_EQ(ctrl[joint.actuator->id], joint.actuator->ctrl_upper);
  }
  ASSERT_TRUE(robot.arm.gripper);
  EXPECT_EQ(ctrl[robot.arm.gripper->drives[0].id], 123.0);
}

TEST(Controller, NamesTheJointThatCannotBeControlled) {
  const Loaded robot = load_text(odd_arm("integrator=\"Euler\""));
  const auto servo = Controller::create(robot.model, robot.arm, ControlMode::servo);
  ASSERT_FALSE(servo);
  EXPECT_THAT(servo.error().what, HasSubstr("\"third\""));
  EXPECT_THAT(servo.error().what, HasSubstr("computed_torque"));

  Arm arm = robot.arm;
  arm.joints[1].actuator.reset();
  const auto bare = Controller::create(robot.model, arm, ControlMode::computed_torque);
  ASSERT_FALSE(bare);
  EXPECT_THAT(bare.error().what, HasSubstr("\"second\""));
  EXPECT_THAT(bare.error().what, HasSubstr("<position"));

  arm = robot.arm;
  arm.joints[0].actuator->gain = 0;
  const auto dead = Controller::create(robot.model, arm, ControlMode::computed_torque);
  ASSERT_FALSE(dead);
  EXPECT_THAT(dead.error().what, HasSubstr("\"first\""));
}

TEST(Controller, RefusesFeedbackThatIsUnstableAtTheTimeStep) {
  const Loaded robot = load_shipped("ur5e");
  const auto make_with = [&](double stiffness, double damping) {
    return Controller::create(robot.model, robot.arm, ControlMode::computed_torque,
                              {.stiffness = stiffness, .damping = damping});
  };
  EXPECT_TRUE(make_with(900, 60));
  EXPECT_TRUE(make_with(1, 990));
  EXPECT_FALSE(make_with(1, 1000));
  EXPECT_FALSE(make_with(0, 60));
  EXPECT_FALSE(make_with(900, 0));
  EXPECT_FALSE(make_with(std::nan(""), 60));
  const auto bad = make_with(1e6, 60);
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().code, Errc::bad_input);
}

TEST(Controller, ModesHaveNames) {
  ASSERT_EQ(control_mode_names().size(), 7U);
  for (const std::string_view word : control_mode_names()) {
    EXPECT_EQ(name(control_mode(word).value()), word);
  }
  EXPECT_EQ(name(ControlMode::tool_impedance), "tool_impedance");
  const auto unknown = control_mode("computed_torqe");
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().what, HasSubstr("did you mean \"computed_torque\""));
}

}  // namespace
}  // namespace mjarm
