#include "mjarm/teleop/teleop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/teleop/random_drive_test.hpp"

namespace mjarm {
namespace {

using testing::drive;

constexpr const char* kPandaPick = "franka_emika_panda/pick.xml";
constexpr const char* kUr5ePick = "universal_robots_ur5e/pick.xml";

/// A robot that is led, from its home.
struct Led {
  explicit Led(const char* scene, const TeleopOptions& options = {})
      : robot(load_robot(scene).value()),
        sim(robot.model),
        teleop(Teleop::create(robot, options).value()) {
    sim.reset_home();
    sim.place(robot.arm, as_span(robot.arm.home));
    teleop.begin(sim);
  }
  void lead(const TeleopInput& input, double seconds) {
    for (const double end = sim.time() + seconds - 1e-9; sim.time() < end;) {
      ASSERT_TRUE(teleop.advance(sim, input));
    }
  }
  /// Until the tool is within 0.5 mm of `p_W`, or stands still on its way.
  void lead_to(const Eigen::Vector3d& p_W, double grip = 0) {
    for (int i = 0; i < 2000; ++i) {
      const Eigen::Vector3d way = p_W - sim.tool(robot.arm).p;
      if (way.norm() < 5e-4) break;
      ASSERT_TRUE(teleop.advance(sim, {.linear = 4 * way, .grip = grip}));
    }
    lead({.grip = grip}, 0.2);
  }
  void point_down() {
    Eigen::Matrix3d down;
    down << 1, 0, 0, 0, -1, 0, 0, 0, -1;
    for (int i = 0; i < 1000; ++i) {
      const Eigen::Vector3d turn = rotation_log(down * tool().R.transpose());
      if (turn.norm() < 2e-3) break;
      ASSERT_TRUE(teleop.advance(sim, {.angular = 3 * turn}));
    }
  }
  [[nodiscard]] Pose tool() const { return sim.tool(robot.arm); }
  [[nodiscard]] Eigen::Vector3d place_of(const std::string& object) const {
    for (const SceneObject& one : scene_bodies(robot.model, robot.arm).objects) {
      if (one.name == object) return sim.body_pose(one.body).p;
    }
    throw std::runtime_error("no " + object);
  }
  /// [rad] The most that a joint is off its reference.
  [[nodiscard]] double off() const {
    return (sim.arm_state(robot.arm).q - teleop.reference()).cwiseAbs().maxCoeff();
  }

  Robot robot;
  Sim sim;
  Teleop teleop;
};

TEST(TeleopGuard, NothingIsTouchedWhateverIsHeldDown) {
  for (const char* scene : {kPandaPick, kUr5ePick}) {
    const Robot robot = load_robot(scene).value();
    for (const std::uint64_t seed : {1, 2}) {
      const testing::DriveResult guarded = drive(robot, {}, seed, 10);
      EXPECT_EQ(guarded.contact, "") << scene << ", seed " << seed << ", " << guarded.time << " s";
      EXPECT_GT(guarded.way, 0.3) << scene << ", seed " << seed;
    }
  }
}

TEST(TeleopGuard, WithoutItTheSameHandsTouchSomething) {
  for (const char* scene : {kPandaPick, kUr5ePick}) {
    const Robot robot = load_robot(scene).value();
    EXPECT_NE(drive(robot, {.guard = false}, 1, 10).contact, "") << scene;
  }
}

TEST(TeleopGuard, StopsAboveTheTableAndSaysSo) {
  Led led(kPandaPick);
  led.lead_to({0.5, 0.35, 0.4});
  led.lead({.linear = {0, 0, -0.25}}, 3);
  const TeleopState state = led.teleop.state();
  EXPECT_EQ(state.limit, TeleopLimit::near);
  ASSERT_TRUE(state.near);
  EXPECT_TRUE(state.near->body1 == "left_finger" || state.near->body1 == "right_finger");
  EXPECT_EQ(state.near->body2, "table");
  // The table's top is at 0.2 m, the pads reach 0.1127 + 0.0002 m beyond the hand and the tool is
  // at 0.1034 m.
  const double room = led.tool().p.z() - 0.2 - (0.0584 + 0.0455 + 0.0088 - 0.1034);
  EXPECT_GT(room, 2.5e-3);
  EXPECT_LT(room, 6e-3);
  const double before = led.tool().p.z();
  led.lead({.linear = {0, 0, 0.1}}, 1);
  EXPECT_GT(led.tool().p.z(), before + 0.07);
}

TEST(TeleopGuard, WhatIsGrippedComesAlong) {
  Led led(kPandaPick);
  const Eigen::Vector3d box(0.42, 0.1, 0.23);
  const auto p_box = [&] { return led.place_of("box"); };
  led.point_down();
  led.lead_to(box + Eigen::Vector3d(0, 0, 0.1));
  led.lead_to(box);
  EXPECT_EQ(led.teleop.state().held, "");
  led.lead({.grip = 2}, 1.5);
  EXPECT_EQ(led.teleop.state().held, "box");
  led.lead_to(box + Eigen::Vector3d(0, 0, 0.15));
  EXPECT_GT(p_box().z(), 0.35);
  // Down again: the box, not the fingers, is what comes near to the table first.
  led.lead({.linear = {0, 0, -0.25}}, 3);
  const TeleopState state = led.teleop.state();
  ASSERT_TRUE(state.near);
  EXPECT_EQ(state.near->body1, "box");
  EXPECT_EQ(state.near->body2, "table");
  EXPECT_LT(p_box().z(), 0.234);
  led.lead({.grip = -2}, 1);
  EXPECT_EQ(led.teleop.state().held, "");
  EXPECT_NEAR(p_box().z(), 0.23, 1e-3);
}

// Neither an arm that is led onto a can nor fingers that open against it press ever harder.
TEST(TeleopGuard, GivesWayToWhatItPushes) {
  Led led(kUr5ePick);
  led.point_down();
  const Eigen::Vector3d can = led.place_of("can");
  led.lead_to(can + Eigen::Vector3d(0, 0, 0.15), 2);
  double most = 0;
  bool pushed = false;
  const auto press = [&](const TeleopInput& input) {
    for (int i = 0; i < 500; ++i) {
      ASSERT_TRUE(led.teleop.advance(led.sim, input));
      most = std::max(most, led.off());
      pushed |= led.teleop.state().limit == TeleopLimit::pushed;
    }
  };
  press({.linear = {0, 0, -0.25}});
  press({.grip = -2});
  EXPECT_TRUE(pushed);
  EXPECT_LT(most, 0.03);
  const double before = led.tool().p.z();
  led.lead({.linear = {0, 0, 0.1}}, 1.5);
  EXPECT_GT(led.tool().p.z(), before + 0.07) << "and it can be led away";
}

TEST(Teleop, LeadsStraightInBothFrames) {
  for (const TwistFrame frame : {TwistFrame::world, TwistFrame::tool}) {
    Led led(kUr5ePick);
    const Pose before = led.tool();
    led.lead({.linear = {0, 0, frame == TwistFrame::world ? 0.1 : -0.1}, .frame = frame}, 1);
    led.lead({}, 0.5);
    const Eigen::Vector3d way = led.tool().p - before.p;
    const Eigen::Vector3d axis =
        frame == TwistFrame::world ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d(-before.R.col(2));
    EXPECT_NEAR(way.dot(axis), 0.1, 0.01);
    EXPECT_LT((way - way.dot(axis) * axis).norm(), 1e-3);
    EXPECT_LT(angle_between(before.R, led.tool().R), 2e-3);
  }
}

TEST(Teleop, TurnsAboutTheTool) {
  Led led(kUr5ePick);
  const Pose before = led.tool();
  led.lead({.angular = {0, 0, 0.5}}, 1);
  led.lead({}, 0.5);
  EXPECT_LT((led.tool().p - before.p).norm(), 1e-3);
  const Eigen::Vector3d turn = rotation_log(led.tool().R * before.R.transpose());
  EXPECT_NEAR(turn.z(), 0.5, 0.05);
  EXPECT_LT(turn.head<2>().norm(), 2e-3);
}

TEST(Teleop, JointsKeepRangesSpeedsAndAccelerations) {
  Led led("panda");
  const JointLimits& limits = led.robot.arm.limits;
  testing::RandomHand hand(3);
  const double dt = led.teleop.period();
  JointVec q1 = led.teleop.reference(), q0 = q1;
  for (int i = 0; i < 5000; ++i) {
    ASSERT_TRUE(led.teleop.advance(led.sim, hand.at(led.sim.time())));
    const JointVec q2 = led.teleop.reference();
    EXPECT_TRUE(within_limits(led.robot.arm, as_span(q2)));
    // Of the mean velocities of two periods, whose ends are as near to each other as the limits
    // let them be.
    const JointVec v = (q2 - q1) / dt, a = (q2 - 2 * q1 + q0) / (dt * dt);
    EXPECT_LE((v.array().abs() / limits.velocity.array()).maxCoeff(), 0.5 + 1e-6);
    EXPECT_LE((a.array().abs() / limits.acceleration.array()).maxCoeff(), 0.5 + 1e-6);
    q0 = q1;
    q1 = q2;
  }
}

TEST(Teleop, SlowsDownTowardsASingularity) {
  Led led("ur5e", {.guard = false});
  // Outwards until the arm is stretched.
  led.lead({.linear = {0, 0.25, 0}}, 6);
  const double smallest =
      smallest_singular_value(fk_jacobian(led.robot.arm, as_span(led.teleop.reference())).J_W);
  EXPECT_LT(smallest, 0.05);
  EXPECT_EQ(led.teleop.state().limit, TeleopLimit::singularity);
  const double before = led.tool().p.y();
  led.lead({.linear = {0, -0.25, 0}}, 2);
  EXPECT_LT(led.tool().p.y(), before - 0.15) << "and gets out of it";
}

TEST(Teleop, SameInputsGiveTheSameBytes) {
  const Robot robot = load_robot(kPandaPick).value();
  EXPECT_EQ(drive(robot, {}, 7, 3).qpos, drive(robot, {}, 7, 3).qpos);
}

TEST(Teleop, GoesOnFromAMomentToTheLastBit) {
  Led led(kPandaPick);
  testing::RandomHand hand(4);
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(led.teleop.advance(led.sim, hand.at(led.sim.time())));
  }
  const TeleopMoment moment = led.teleop.moment(led.sim);
  const TeleopInput input{.linear = {0.1, -0.1, 0}, .grip = 1};
  led.lead(input, 1);
  const std::vector<double> once(led.sim.qpos().begin(), led.sim.qpos().end());
  ASSERT_TRUE(led.teleop.go_to(led.sim, moment));
  led.lead(input, 1);
  const std::vector<double> again(led.sim.qpos().begin(), led.sim.qpos().end());
  EXPECT_EQ(once, again);
  EXPECT_FALSE(Led("ur5e").teleop.go_to(led.sim, moment));
}

TEST(Teleop, WhatIsNoNumberMovesNothing) {
  Led led("ur5e");
  const JointVec before = led.teleop.reference();
  led.lead({.linear = {NAN, 0.1, 0}, .angular = {0, INFINITY, 0}, .grip = NAN}, 0.2);
  EXPECT_EQ(led.teleop.reference(), before);
}

TEST(Teleop, RefusesOptionsOutOfRange) {
  const Robot robot = load_robot("ur5e").value();
  for (const TeleopOptions& options :
       {TeleopOptions{.period = 0}, TeleopOptions{.speed = -1}, TeleopOptions{.turn = NAN},
        TeleopOptions{.velocity_share = 1.5}, TeleopOptions{.acceleration_share = 0},
        TeleopOptions{.watch = {.margin = 0}}}) {
    const auto made = Teleop::create(robot, options);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, Errc::bad_input);
    EXPECT_FALSE(made.error().what.empty());
  }
}

}  // namespace
}  // namespace mjarm
