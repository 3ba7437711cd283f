#include "mjarm/sim/follow.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mjarm/control/sag.hpp"
#include "mjarm/core/messages.hpp"
#include "mjarm/sim/worlds_test.hpp"

namespace mjarm {
namespace {

using testing::controller_of;
using ::testing::HasSubstr;
using testing::load_shipped;
using testing::load_text;
using testing::Loaded;
using testing::small_world;

Trajectory move(const JointVec& from, const JointVec& to, double seconds) {
  auto trajectory =
      Trajectory::through({0, seconds}, {JointState::at_rest(from), JointState::at_rest(to)});
  if (!trajectory) throw std::runtime_error(trajectory.error().what);
  return std::move(*trajectory);
}

/// What a run needs, the arm at home.
struct Bench {
  Loaded robot;
  Sim sim;
  Controller controller;

  Bench(Loaded loaded, ControlMode mode)
      : robot(std::move(loaded)), sim(robot.model), controller(controller_of(robot, mode)) {
    EXPECT_TRUE(sim.reset("home"));
    sim.place(robot.arm, as_span(robot.arm.home));
  }
  [[nodiscard]] FollowSetup setup() {
    return {.sim = sim, .controller = controller, .arm = robot.arm};
  }
};

JointVec shifted(const JointVec& q, double by) { return q + JointVec::Constant(q.size(), by); }

/// Hanging below the horizontal, so that a servo on its way up stops short.
const std::vector<double> kBelow{0.5, 0};

/// `n` waypoints on the way from `from` to `to`, without `from` itself.
std::vector<JointVec> waypoints(const JointVec& from, const JointVec& to, int n) {
  std::vector<JointVec> all;
  for (int i = 1; i <= n; ++i) all.emplace_back(from + (to - from) * i / n);
  return all;
}

TEST(FollowTime, ComputedTorqueFollowsToTheEnd) {
  Bench bench(load_shipped("ur5e"), ControlMode::computed_torque);
  const JointVec home = bench.robot.arm.home;
  const Trajectory trajectory = move(home, shifted(home, 0.4), 1.5);
  const auto outcome = follow_time(bench.setup(), trajectory, {.settle = 0.25});
  ASSERT_TRUE(outcome) << describe(outcome.error(), bench.robot.arm);
  EXPECT_EQ(outcome->reached, 1U);
  EXPECT_EQ(outcome->steps, 875);
  EXPECT_NEAR(outcome->duration, 1.75, 1e-9);
  EXPECT_FALSE(outcome->stopped);
  EXPECT_LT(outcome->worst_error, 1e-9);
  EXPECT_LT(outcome->final_tool_error, 1e-9);
  EXPECT_EQ(outcome->limited_steps, 0);
  EXPECT_FALSE(outcome->first_contact);
  // 0.4 rad in 1.5 s by a quintic: largest speed 1.875 times the mean.
  EXPECT_NEAR(outcome->velocity_use * bench.robot.arm.limits.velocity.minCoeff(), 0.5, 0.01);
  EXPECT_GT(outcome->torque_use, 0.05);
  EXPECT_LT(outcome->torque_use, 1);
}

TEST(FollowTime, ServoSagsByMillimetresAndGravityFeedForwardMendsIt) {
  const auto final_tool_error = [](ControlMode mode) {
    Bench bench(load_shipped("ur5e"), mode);
    const JointVec home = bench.robot.arm.home;
    const auto outcome =
        follow_time(bench.setup(), move(home, shifted(home, 0.3), 1), {.settle = 3});
    EXPECT_TRUE(outcome);
    return outcome ? outcome->final_tool_error : 0.0;
  };
  EXPECT_GT(final_tool_error(ControlMode::servo), 0.003);
  EXPECT_LT(final_tool_error(ControlMode::servo_gravity), 1e-4);
  EXPECT_LT(final_tool_error(ControlMode::computed_torque), 1e-5);
}

TEST(FollowTime, SameRunSameLog) {
  const auto log = [] {
    Bench bench(load_shipped("panda"), ControlMode::computed_torque);
    Recorder recorder(bench.robot.model, bench.robot.arm, {.every = 3});
    FollowSetup setup = bench.setup();
    setup.recorder = &recorder;
    const JointVec home = bench.robot.arm.home;
    EXPECT_TRUE(follow_time(setup, move(home, shifted(home, 0.2), 0.5)));
    return recorder.to_csv();
  };
  const std::string first = log();
  EXPECT_GT(first.size(), 10000U);
  EXPECT_EQ(first, log());
}

TEST(FollowTime, StopsWhenAsked) {
  Bench bench(load_text(small_world()), ControlMode::servo);
  FollowSetup setup = bench.setup();
  int calls = 0;
  setup.after_step = [&](const Sim&, const JointVec&) { return ++calls < 10; };
  const auto outcome = follow_time(setup, move(bench.robot.arm.home, JointVec::Zero(2), 1));
  ASSERT_TRUE(outcome);
  EXPECT_TRUE(outcome->stopped);
  EXPECT_EQ(outcome->steps, 10);
  EXPECT_EQ(outcome->reached, 0U);
}

TEST(FollowTime, TellsTheFirstContactOfTheArmOnly) {
  Bench bench(load_text(small_world()), ControlMode::computed_torque);
  JointVec into_floor = bench.robot.arm.home;
  into_floor << 1.1, 0.2;
  const auto outcome = follow_time(bench.setup(), move(bench.robot.arm.home, into_floor, 1));
  ASSERT_TRUE(outcome);
  ASSERT_TRUE(outcome->first_contact);
  EXPECT_EQ(outcome->first_contact->contact.first, "floor");
  EXPECT_EQ(outcome->first_contact->contact.second, "lower");
  EXPECT_GT(outcome->first_contact->time, 0.3);
  EXPECT_LT(outcome->first_contact->time, 1.0);
}

TEST(FollowTime, KeepsTheGripperAsItWasSet) {
  Bench bench(load_shipped("panda"), ControlMode::computed_torque);
  ASSERT_TRUE(bench.robot.arm.gripper);
  bench.sim.set_ctrl(bench.robot.arm.gripper->id, 77);
  const JointVec home = bench.robot.arm.home;
  ASSERT_TRUE(follow_time(bench.setup(), move(home, shifted(home, 0.1), 0.2)));
  EXPECT_EQ(bench.sim.ctrl()[bench.robot.arm.gripper->id], 77);
}

TEST(FollowTime, InstabilityIsAFailureThatSaysSo) {
  Bench bench(load_text(small_world("timestep=\"0.05\" integrator=\"Euler\"", "20000")),
              ControlMode::servo);
  const auto outcome = follow_time(bench.setup(), move(bench.robot.arm.home, JointVec::Zero(2), 9));
  ASSERT_FALSE(outcome);
  ASSERT_TRUE(outcome.error().error);
  EXPECT_FALSE(outcome.error().wait);
  EXPECT_THAT(describe(outcome.error(), bench.robot.arm), HasSubstr("unstable"));
}

TEST(Follow, MotionsOfAnotherArmAreRefused) {
  Bench bench(load_text(small_world()), ControlMode::servo);
  const JointVec seven = JointVec::Zero(7);
  const auto by_time = follow_time(bench.setup(), move(seven, seven, 1));
  ASSERT_FALSE(by_time);
  EXPECT_THAT(describe(by_time.error(), bench.robot.arm), HasSubstr("7 joints"));
  const std::vector<JointVec> waypoints{bench.robot.arm.home, seven};
  const auto gated = follow_joints(bench.setup(), waypoints);
  ASSERT_FALSE(gated);
  ASSERT_TRUE(gated.error().error);
  EXPECT_EQ(gated.error().error->code, Errc::usage);
  EXPECT_EQ(bench.sim.time(), 0);
}

TEST(FollowJoints, GoesFromWaypointToWaypoint) {
  Bench bench(load_shipped("ur5e"), ControlMode::servo_gravity);
  const JointVec home = bench.robot.arm.home;
  const JointVec goal = shifted(home, 0.5);
  const auto outcome = follow_joints(bench.setup(), waypoints(home, goal, 25));
  ASSERT_TRUE(outcome) << describe(outcome.error(), bench.robot.arm);
  EXPECT_EQ(outcome->reached, 25U);
  EXPECT_LE((bench.sim.arm_state(bench.robot.arm).q - goal).cwiseAbs().maxCoeff(), 0.02);
  EXPECT_GT(outcome->steps, 25);
}

TEST(FollowJoints, SaysThatTheServoSagsMoreThanTheTolerance) {
  Bench bench(load_text(small_world("integrator=\"implicitfast\"", "100")), ControlMode::servo);
  bench.sim.place(bench.robot.arm, kBelow);
  const std::vector<JointVec> goals{joint_vec(kBelow), JointVec::Zero(2)};
  const auto outcome = follow_joints(bench.setup(), goals, {.joint_tol = 0.08, .max_steps = 3000});
  ASSERT_FALSE(outcome);
  ASSERT_TRUE(outcome.error().wait);
  const FollowWait& wait = *outcome.error().wait;
  EXPECT_EQ(wait.cause, WaitCause::sag);
  EXPECT_EQ(wait.count, 2U);
  EXPECT_EQ(wait.steps, 3000);
  EXPECT_EQ(bench.robot.arm.joints[wait.joint].name, "shoulder");
  EXPECT_EQ(wait.waypoint, 1U);
  EXPECT_GT(wait.distance, 0.08);
  EXPECT_NEAR(wait.distance, wait.sag, 1e-3) << "at rest the sag is all there is";
  EXPECT_EQ(wait.stiffness, 100);
  EXPECT_NEAR(wait.torque / wait.stiffness, wait.sag, 1e-12);
  const std::string words = describe(outcome.error(), bench.robot.arm);
  EXPECT_THAT(words, HasSubstr("\"shoulder\""));
  EXPECT_THAT(words, HasSubstr("sags"));
  EXPECT_THAT(words, HasSubstr("0.08"));
  set_language(Language::chinese);
  EXPECT_THAT(describe(outcome.error(), bench.robot.arm), HasSubstr("下垂"));
  set_language(Language::english);
}

TEST(FollowTool, SaysThatTheServoSagsMoreThanTheTolerance) {
  Bench bench(load_text(small_world("integrator=\"implicitfast\"", "400")), ControlMode::servo);
  const std::vector<JointVec> goals{JointVec::Zero(2)};
  bench.sim.place(bench.robot.arm, as_span(goals[0]));
  const std::vector<Eigen::Vector3d> points{bench.sim.tool(bench.robot.arm).p};
  bench.sim.place(bench.robot.arm, kBelow);
  const auto outcome =
      follow_tool(bench.setup(), goals, points, {.tool_tol = 0.01, .max_steps = 3000});
  ASSERT_FALSE(outcome);
  ASSERT_TRUE(outcome.error().wait);
  const FollowWait& wait = *outcome.error().wait;
  EXPECT_EQ(wait.cause, WaitCause::sag);
  EXPECT_EQ(wait.joint, -1);
  EXPECT_GT(wait.distance, 0.01);
  EXPECT_NEAR(wait.sag, wait.distance, 1e-3);
  EXPECT_THAT(describe(outcome.error(), bench.robot.arm), HasSubstr("servo_gravity"));

  Bench better(load_text(small_world()), ControlMode::servo_gravity);
  EXPECT_TRUE(follow_tool(better.setup(), goals, points, {.tool_tol = 0.01, .max_steps = 3000}));
}

TEST(FollowJoints, TellsOtherCausesApart) {
  {
    Bench bench(load_text(small_world()), ControlMode::servo);
    const std::vector<JointVec> far{shifted(bench.robot.arm.home, 0.2)};
    const auto slow = follow_joints(bench.setup(), far, {.joint_tol = 0.001, .max_steps = 40});
    ASSERT_FALSE(slow);
    EXPECT_EQ(slow.error().wait->cause, WaitCause::moving);
    EXPECT_THAT(describe(slow.error(), bench.robot.arm), HasSubstr("more steps"));
  }
  {
    Bench bench(load_text(small_world()), ControlMode::servo_gravity);
    JointVec into_floor(2);
    into_floor << 1.0, 0.1;
    const std::vector<JointVec> goals{into_floor};
    const auto blocked = follow_joints(bench.setup(), goals);
    ASSERT_FALSE(blocked);
    EXPECT_EQ(blocked.error().wait->cause, WaitCause::contact);
    EXPECT_THAT(describe(blocked.error(), bench.robot.arm), HasSubstr("\"floor\""));
    EXPECT_EQ(blocked.error().outcome.reached, 0U);
    ASSERT_TRUE(blocked.error().outcome.first_contact);
  }
  {
    Bench bench(load_text(small_world("gravity=\"0 0 -90\" integrator=\"implicitfast\"", "4000")),
                ControlMode::servo_gravity);
    bench.sim.place(bench.robot.arm, kBelow);
    const std::vector<JointVec> goals{JointVec::Zero(2)};
    const auto weak = follow_joints(bench.setup(), goals);
    ASSERT_FALSE(weak);
    EXPECT_EQ(weak.error().wait->cause, WaitCause::force_limit);
  }
}

}  // namespace
}  // namespace mjarm
