#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "mjarm/control/actuation.hpp"
#include "mjarm/control/world_test.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/kinematics/self_motion.hpp"

/// The integral, the feed-forward and the impedances, against MuJoCo with loads that the controller
/// does not know.
namespace mjarm {
namespace {

using testing::controller_of;
using ::testing::HasSubstr;
using testing::load_shipped;
using testing::Loaded;
using testing::swing;
using testing::swing_reference;
using testing::World;

constexpr ControlOptions kWithIntegral{.stiffness = 4800, .damping = 120, .integral = 64000};

/// Hangs `mass` [kg] into the centre of the last link.
void load(World& world, const Loaded& robot, double mass) {
  mjModel& m = world.m();
  const int body = m.jnt_bodyid[mj_name2id(&m, mjOBJ_JOINT, robot.arm.joints.back().name.c_str())];
  m.body_mass[body] += mass;
  mj_setConst(&m, &world.d());
  for (int i = 0; i < robot.arm.dof(); ++i) {
    world.d().qpos[robot.arm.joints[i].qpos] = robot.arm.home[i];
  }
}

/// Largest joint error from 3 s on of a swing with a load of 1 kg.
double loaded_error(const ControlOptions& options) {
  const Loaded robot = load_shipped("ur5e");
  Controller controller = controller_of(robot, ControlMode::computed_torque, options);
  World world(robot, robot.arm.home);
  load(world, robot, 1);
  const double h = robot.model.timestep();
  double worst = 0;
  for (int i = 0; i < 3000; ++i) {
    const StepReference reference = swing_reference(robot.arm, i, h);
    EXPECT_FALSE(world.step(controller, reference)) << "step " << i;
    const double error = (world.q() - reference.next).cwiseAbs().maxCoeff();
    if (i * h > 3) worst = std::max(worst, error);
  }
  return worst;
}

TEST(Integral, TakesUpALoadThatTheModelDoesNotKnow) {
  const double with = loaded_error(kWithIntegral);
  const double without = loaded_error({});
  EXPECT_LT(with, 1e-4);
  EXPECT_GT(without, 20 * with);
}

TEST(Integral, LeavesNoErrorAtRestAndForgetsWhenAsked) {
  const Loaded robot = load_shipped("ur5e");
  Controller controller = controller_of(robot, ControlMode::computed_torque, kWithIntegral);
  World world(robot, robot.arm.home);
  load(world, robot, 1);
  const StepReference home = hold(as_span(robot.arm.home));
  for (int i = 0; i < 1500; ++i) world.step(controller, home);
  EXPECT_LT((world.q() - robot.arm.home).cwiseAbs().maxCoeff(), 1e-9);
  const std::vector<double> held = world.ctrl();
  controller.restart();
  world.step(controller, home);
  EXPECT_NE(world.ctrl(), held);
}

/// By how much joint 1 passes the end of a jump whose way is cut by force limits [rad].
double overshoot(double integral) {
  const Loaded robot = load_shipped("ur5e");
  ControlOptions options = kWithIntegral;
  options.integral = integral;
  Controller controller = controller_of(robot, ControlMode::computed_torque, options);
  World world(robot, robot.arm.home);
  JointVec far = robot.arm.home;
  far[0] += 1.5;
  double over = 0;
  for (int i = 0; i < 2500; ++i) {
    world.step(controller, hold(as_span(far)));
    over = std::max(over, world.q()[0] - far[0]);
  }
  EXPECT_LT((world.q() - far).cwiseAbs().maxCoeff(), 1e-6);
  return over;
}

TEST(Integral, DoesNotWindUpBehindALimit) {
  // The jump overshoots in any case, since the brake is limited too.
  EXPECT_LT(overshoot(kWithIntegral.integral), overshoot(0) + 0.01);
}

/// Largest modulus of the poles of the sampled loop, from its matrix.
double spectral_radius(const ControlOptions& o, double h) {
  Eigen::MatrixXd A(3, 3);  // states e, e_v, sum
  const double e = -h * o.stiffness, v = 1 - h * o.damping, s = -h * o.integral;
  A << 1 + h * e, h * v, h * s, e, v, s, h, 0, 1;
  return A.eigenvalues().cwiseAbs().maxCoeff();
}

TEST(Integral, LoopsAreRefusedExactlyWhereTheyAreUnstable) {
  const Loaded robot = load_shipped("ur5e");
  const double h = robot.model.timestep();
  Rng rng(3);
  int stable = 0, unstable = 0;
  for (int i = 0; i < 300; ++i) {
    const ControlOptions options{.stiffness = std::pow(10, rng.uniform(1, 6.5)),
                                 .damping = std::pow(10, rng.uniform(0, 3.2)),
                                 .integral = std::pow(10, rng.uniform(2, 9))};
    const double radius = spectral_radius(options, h);
    if (std::abs(radius - 1) < 1e-9) continue;
    const auto controller =
        Controller::create(robot.model, robot.arm, ControlMode::computed_torque, options);
    EXPECT_EQ(controller.has_value(), radius < 1)
        << radius << ": " << options.stiffness << ' ' << options.damping << ' ' << options.integral;
    ++(radius < 1 ? stable : unstable);
  }
  EXPECT_GT(stable, 50);
  EXPECT_GT(unstable, 50);
}

TEST(FeedForward, FollowsToRoundingAndYieldsLikeTheServo) {
  const Loaded robot = load_shipped("ur5e");
  Controller controller = controller_of(robot, ControlMode::feed_forward);
  World world(robot, robot.arm.home);
  const double h = robot.model.timestep();
  for (int i = 0; i < 1500; ++i) {
    const StepReference reference = swing_reference(robot.arm, i, h);
    EXPECT_FALSE(world.step(controller, reference));
    EXPECT_LT((world.q() - reference.next).cwiseAbs().maxCoeff(), 1e-9) << "step " << i;
  }
  const JointVec there = swing(robot.arm, 1500 * h);
  const int dof = robot.arm.joints[2].dof;
  world.d().qfrc_applied[dof] = 5;
  for (int i = 0; i < 4000; ++i) world.step(controller, hold(as_span(there)));
  const double expected = 5 / servo_stiffness(*robot.arm.joints[2].actuator);
  EXPECT_NEAR((world.q() - there)[2], expected, 1e-3 * expected);
}

TEST(JointImpedance, FollowsToRoundingAndYieldsLikeItsSprings) {
  const Loaded robot = load_shipped("panda");
  Controller controller =
      controller_of(robot, ControlMode::joint_impedance, {.impedance = {.joint_stiffness = 150}});
  World world(robot, robot.arm.home);
  const StepReference home = hold(as_span(robot.arm.home));
  for (int i = 0; i < 500; ++i) world.step(controller, home);
  EXPECT_LT((world.q() - robot.arm.home).cwiseAbs().maxCoeff(), 1e-4);
  for (const ArmJoint& joint : robot.arm.joints) world.d().qfrc_applied[joint.dof] = 3;
  for (int i = 0; i < 6000; ++i) world.step(controller, home);
  const JointVec off = world.q() - robot.arm.home;
  for (int i = 0; i < 7; ++i) EXPECT_NEAR(off[i], 3.0 / 150, 1e-5) << i;
}

/// Pushes the tool with `force` [N] in x; by how much it has moved once it rests.
Eigen::Vector3d yield_to(const Loaded& robot, double force, const Impedance& impedance) {
  Controller controller =
      controller_of(robot, ControlMode::tool_impedance, {.impedance = impedance});
  World world(robot, robot.arm.home);
  const StepReference home = hold(as_span(robot.arm.home));
  const Eigen::Vector3d start = fk(robot.arm, as_span(robot.arm.home)).p;
  const int body =
      world.m()
          .jnt_bodyid[mj_name2id(&world.m(), mjOBJ_JOINT, robot.arm.joints.back().name.c_str())];
  for (int i = 0; i < 8000; ++i) {
    mju_zero(world.d().qfrc_applied, static_cast<int>(world.m().nv));
    const Eigen::Vector3d p = fk(robot.arm, as_span(world.q())).p, push(force, 0, 0);
    mj_applyFT(&world.m(), &world.d(), push.data(), nullptr, p.data(), body,
               world.d().qfrc_applied);
    EXPECT_FALSE(world.step(controller, home));
  }
  return fk(robot.arm, as_span(world.q())).p - start;
}

TEST(ToolImpedance, YieldsToAForceLikeItsSpring) {
  for (const char* name : {"ur5e", "panda"}) {
    const Loaded robot = load_shipped(name);
    const Eigen::Vector3d moved = yield_to(robot, 10, {.tool_stiffness = 500});
    EXPECT_NEAR(moved.x(), 10.0 / 500, 2e-5) << name;
    EXPECT_LT(moved.tail<2>().norm(), 2e-5) << name;
  }
}

TEST(ToolImpedance, MovesJointsToSpareWithTheToolAtRest) {
  const Loaded robot = load_shipped("panda");
  const IkSolver ik(robot.arm);
  const Pose X = fk(robot.arm, as_span(robot.arm.home));
  JointVec posture = robot.arm.home;
  posture[0] += 0.4;
  const auto other = null_space_step(ik, X, as_span(robot.arm.home),
                                     {.goal = PostureGoal::near_posture, .posture = posture});
  ASSERT_TRUE(other.has_value());
  ASSERT_GT((other->q - robot.arm.home).norm(), 0.1);
  Controller controller = controller_of(robot, ControlMode::tool_impedance);
  World world(robot, robot.arm.home);
  double worst = 0;
  for (int i = 0; i < 6000; ++i) {
    world.step(controller, hold(as_span(other->q)));
    worst = std::max(worst, (fk(robot.arm, as_span(world.q())).p - X.p).norm());
  }
  EXPECT_LT((world.q() - other->q).cwiseAbs().maxCoeff(), 5e-3);
  EXPECT_LT(worst, 5e-3);
}

TEST(Impedance, RefusesSpringsThatAreNone) {
  const Loaded robot = load_shipped("ur5e");
  const auto refused = [&](const Impedance& impedance) {
    const auto made = Controller::create(robot.model, robot.arm, ControlMode::tool_impedance,
                                         {.impedance = impedance});
    return made ? std::string() : made.error().what;
  };
  EXPECT_EQ(refused({}), "");
  EXPECT_EQ(refused({.posture_stiffness = 0, .damping_ratio = 0}), "");
  EXPECT_THAT(refused({.joint_stiffness = 0}), HasSubstr("joint_stiffness"));
  EXPECT_THAT(refused({.tool_stiffness = -1}), HasSubstr("tool_stiffness"));
  EXPECT_THAT(refused({.tool_turn_stiffness = std::nan("")}), HasSubstr("tool_turn_stiffness"));
  EXPECT_THAT(refused({.posture_stiffness = -1}), HasSubstr("posture_stiffness"));
  EXPECT_THAT(refused({.damping_ratio = INFINITY}), HasSubstr("damping_ratio"));
}

}  // namespace
}  // namespace mjarm
