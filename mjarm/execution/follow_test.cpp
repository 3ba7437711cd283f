#include "mjarm/execution/follow.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mjarm/control/sag.hpp"
#include "mjarm/core/messages.hpp"
#include "mjarm/execution/execution_test.hpp"

namespace mjarm {
namespace {

using testing::controller_of;
using ::testing::HasSubstr;
using testing::load_shipped;
using testing::load_text;
using testing::Loaded;
using testing::shifted;
using testing::small_world;

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

/// Hanging below the horizontal, so that a servo on its way up stops short.
const std::vector<double> kBelow{0.5, 0};

/// `n` waypoints on the way from `from` to `to`, without `from` itself.
std::vector<JointVec> waypoints(const JointVec& from, const JointVec& to, int n) {
  std::vector<JointVec> all;
  for (int i = 1; i <= n; ++i) all.emplace_back(from + (to - from) * i / n);
  return all;
}

TEST(FollowJoints, MotionsOfAnotherArmAreRefused) {
  Bench bench(load_text(small_world()), ControlMode::servo);
  const std::vector<JointVec> waypoints{bench.robot.arm.home, JointVec::Zero(7)};
  const auto gated = follow_joints(bench.setup(), waypoints);
  ASSERT_FALSE(gated);
  ASSERT_TRUE(gated.error().error);
  EXPECT_EQ(gated.error().error->code, Errc::usage);
  EXPECT_THAT(describe(gated.error(), bench.robot.arm), HasSubstr("7 joints"));
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

TEST(FollowJoints, StopsWhenAskedAndRecordsEachStep) {
  Bench bench(load_text(small_world()), ControlMode::servo);
  Recorder recorder(bench.robot.model, bench.robot.arm);
  FollowSetup setup = bench.setup();
  setup.recorder = &recorder;
  int calls = 0;
  setup.after_step = [&](const Sim&) { return ++calls < 10; };
  const std::vector<JointVec> far{shifted(bench.robot.arm.home, 0.5)};
  const auto outcome = follow_joints(setup, far);
  ASSERT_TRUE(outcome);
  EXPECT_TRUE(outcome->stopped);
  EXPECT_EQ(outcome->steps, 10);
  EXPECT_EQ(outcome->reached, 0U);
  EXPECT_EQ(recorder.size(), 11U);
}

TEST(FollowJoints, InstabilityIsAFailureThatSaysSo) {
  Bench bench(load_text(small_world("timestep=\"0.05\" integrator=\"Euler\"", "20000")),
              ControlMode::servo);
  const std::vector<JointVec> goals{JointVec::Zero(2)};
  const auto outcome = follow_joints(bench.setup(), goals, {.joint_tol = 1e-9});
  ASSERT_FALSE(outcome);
  ASSERT_TRUE(outcome.error().error);
  EXPECT_FALSE(outcome.error().wait);
  EXPECT_THAT(describe(outcome.error(), bench.robot.arm), HasSubstr("unstable"));
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
