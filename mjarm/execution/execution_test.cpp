#include "mjarm/execution/execution.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include "mjarm/core/rng.hpp"
#include "mjarm/execution/execution_test.hpp"

namespace mjarm {
namespace {

using ::testing::HasSubstr;
using testing::load_shipped;
using testing::load_text;
using testing::Loaded;
using testing::rest_to_rest;
using testing::shifted;
using testing::small_world;
using testing::there_and_half_back;
using State = Execution::State;

/// A robot that stands at its home.
struct World {
  Loaded robot;
  Sim sim;
  explicit World(Loaded loaded) : robot(std::move(loaded)), sim(robot.model) {
    EXPECT_TRUE(sim.reset("home"));
    sim.place(robot.arm, as_span(robot.arm.home));
  }
  [[nodiscard]] Result<FollowOutcome> run(const MotionPlan& plan, const ExecutionOptions& options,
                                          const Execution::AfterStep& after_step = {}) {
    return Execution::create(robot.model, plan, options).and_then([&](Execution&& execution) {
      return execution.run_to_end(sim, after_step);
    });
  }
  [[nodiscard]] JointVec q() const { return sim.arm_state(robot.arm).q; }
};

/// How far the joints are off at rest at the end of `plan`, in a world of its own.
double error_at_rest(const Model& model, const Arm& arm, const MotionPlan& plan) {
  Sim sim(model);
  sim.place(arm, as_span(arm.home));
  Result<Execution> execution =
      Execution::create(model, plan, {.control = ControlMode::servo_gravity, .rest = 2});
  EXPECT_TRUE(execution->run_to_end(sim).has_value());
  return execution->error(sim).cwiseAbs().maxCoeff();
}

TEST(Execution, PayloadIsCarriedAndKnown) {
  const Loaded robot = load_shipped("ur5e");
  const Payload payload{2, {0.02, -0.01, 0.06}};
  MotionPlan plan = there_and_half_back(robot.arm);
  const Model loaded = with_payload(robot.model, robot.arm.tip, payload).value();
  // A controller that is told of a load that nobody carries holds the arm too high, as one that is
  // not told of a load lets it sag: both must be off, or the test sees nothing.
  const double unknown = [&] {
    Sim sim(loaded);
    sim.place(robot.arm, as_span(robot.arm.home));
    Result<Execution> execution =
        Execution::create(robot.model, plan, {.control = ControlMode::servo_gravity, .rest = 2});
    EXPECT_TRUE(execution->run_to_end(sim).has_value());
    return execution->error(sim).cwiseAbs().maxCoeff();
  }();
  EXPECT_GT(unknown, 1e-3);
  for (PlannedMove& move : plan.moves) move.payload = payload;
  EXPECT_LT(error_at_rest(robot.model, robot.arm, plan), 1e-5);
}

TEST(Execution, PayloadHangsAtTheToolAsLongAsThePlanHasIt) {
  const Loaded robot = load_shipped("ur5e");
  const Payload payload{2, {0.02, -0.01, 0.06}};
  MotionPlan plan = there_and_half_back(robot.arm);
  plan.moves[0].payload = payload;
  Sim sim(robot.model);
  sim.place(robot.arm, as_span(robot.arm.home));
  Result<Execution> execution =
      Execution::create(robot.model, plan, {.control = ControlMode::servo_gravity, .rest = 2});
  const auto mass_of = [](const Model& model) {
    double mass = 0;
    for (int i = 0; i < model.raw()->nbody; ++i) mass += model.raw()->body_mass[i];
    return mass;
  };
  std::vector<double> masses;
  const auto outcome = execution->run_to_end(sim, [&](const Sim& world) {
    const double mass = mass_of(world.model());
    if (masses.empty() || masses.back() != mass) masses.push_back(mass);
    return true;
  });
  ASSERT_TRUE(outcome.has_value());
  const double bare = mass_of(robot.model);
  ASSERT_EQ(masses.size(), 2u);
  EXPECT_NEAR(masses[0], bare + payload.mass, 1e-12);
  EXPECT_NEAR(masses[1], bare, 1e-12);
  EXPECT_LT(execution->error(sim).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(Execution, ComputedTorqueFollowsToTheEnd) {
  World world(load_shipped("ur5e"));
  const JointVec home = world.robot.arm.home;
  const MotionPlan plan =
      MotionPlan::of(world.robot.arm, rest_to_rest(home, shifted(home, 0.4), 1.5));
  const auto outcome = world.run(plan, {.rest = 0.25});
  ASSERT_TRUE(outcome) << outcome.error().what;
  EXPECT_EQ(outcome->reached, 1U);
  EXPECT_EQ(outcome->steps, 875);
  EXPECT_NEAR(outcome->duration, 1.75, 1e-9);
  EXPECT_FALSE(outcome->stopped);
  EXPECT_LT(outcome->worst_error, 1e-9);
  EXPECT_LT(outcome->final_tool_error, 1e-9);
  EXPECT_EQ(outcome->limited_steps, 0);
  EXPECT_FALSE(outcome->first_contact);
  // 0.4 rad in 1.5 s by a quintic: largest speed 1.875 times the mean.
  EXPECT_NEAR(outcome->velocity_use * world.robot.arm.limits.velocity.minCoeff(), 0.5, 0.01);
  EXPECT_GT(outcome->torque_use, 0.05);
  EXPECT_LT(outcome->torque_use, 1);
}

TEST(Execution, ServoSagsByMillimetresAndGravityFeedForwardMendsIt) {
  const auto final_tool_error = [](ControlMode mode) {
    World world(load_shipped("ur5e"));
    const JointVec home = world.robot.arm.home;
    const auto outcome =
        world.run(MotionPlan::of(world.robot.arm, rest_to_rest(home, shifted(home, 0.3), 1)),
                  {.control = mode, .rest = 3});
    EXPECT_TRUE(outcome);
    return outcome ? outcome->final_tool_error : 0.0;
  };
  EXPECT_GT(final_tool_error(ControlMode::servo), 0.003);
  EXPECT_LT(final_tool_error(ControlMode::servo_gravity), 1e-4);
  EXPECT_LT(final_tool_error(ControlMode::computed_torque), 1e-5);
}

TEST(Execution, TellsEachMotionAndTheirSum) {
  World world(load_text(small_world()));
  const MotionPlan plan = there_and_half_back(world.robot.arm);
  Execution execution = Execution::create(world.robot.model, plan, {.rest = 0.1}).value();
  const auto outcome = execution.run_to_end(world.sim);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(execution.state(), State::done);
  ASSERT_EQ(execution.motions().size(), 2U) << "what takes no time is passed";
  const ExecutedMotion &first = execution.motions()[0], &second = execution.motions()[1];
  EXPECT_EQ(first.move, 0U);
  EXPECT_EQ(second.move, 2U);
  EXPECT_EQ(first.from, 0);
  EXPECT_EQ(first.to, second.from);
  EXPECT_EQ(second.to, world.sim.time());
  EXPECT_EQ(outcome->reached, 2U);
  EXPECT_EQ(outcome->steps, first.outcome.steps + second.outcome.steps);
  EXPECT_EQ(outcome->torque_use, std::max(first.outcome.torque_use, second.outcome.torque_use));
  EXPECT_NEAR(outcome->duration, plan.duration() + 0.1, 1e-9);
  EXPECT_LT((world.q() - plan.q_end()).norm(), 1e-6);
  EXPECT_EQ(execution.run_to_end(world.sim)->steps, outcome->steps) << "nothing is left";
}

TEST(Execution, SameRunSameLog) {
  const auto log = [] {
    World world(load_shipped("panda"));
    Recorder recorder(world.robot.model, world.robot.arm, {.every = 3});
    EXPECT_TRUE(world.run(there_and_half_back(world.robot.arm), {.recorder = &recorder}));
    return recorder.to_csv();
  };
  const std::string first = log();
  EXPECT_GT(first.size(), 10000U);
  EXPECT_EQ(first, log());
}

TEST(Execution, StepByStepIsTheSameAsAllAtOnceAndSoIsTheSecondTime) {
  const Loaded robot = load_text(small_world());
  const MotionPlan plan = there_and_half_back(robot.arm);
  World whole(robot), singly(robot);
  ASSERT_TRUE(whole.run(plan, {}));
  Execution execution = Execution::create(robot.model, plan).value();
  for (int time = 0; time < 2; ++time) {
    EXPECT_EQ(execution.state(), State::ready);
    for (std::size_t i = 0; i < plan.moves.size(); ++i) {
      execution.run_one();
      while (execution.state() == State::running) ASSERT_TRUE(execution.step(singly.sim));
    }
    EXPECT_EQ(execution.state(), State::done);
    // A motion that takes no time still takes the step in which it is passed, at rest.
    EXPECT_LT((singly.q() - whole.q()).norm(), 1e-9);
    execution.restart();
    EXPECT_TRUE(execution.motions().empty());
    ASSERT_TRUE(singly.sim.reset("home"));
    singly.sim.place(robot.arm, as_span(robot.arm.home));
  }
}

/// Stops anywhere change when the arm is where, not where it goes.
TEST(Execution, WithPausesItEndsWhereItEndsWithoutThem) {
  const Loaded robot = load_text(small_world());
  const MotionPlan plan = there_and_half_back(robot.arm);
  World straight(robot);
  ASSERT_TRUE(straight.run(plan, {}));
  Rng rng(5);
  for (int trial = 0; trial < 10; ++trial) {
    World world(robot);
    Execution execution = Execution::create(robot.model, plan).value();
    execution.run();
    int stops = 0;
    double fastest = 0;
    for (int i = 0; i < 20000 && execution.state() != State::done; ++i) {
      if (rng.uniform() < 0.01) execution.stop(), ++stops;
      if (rng.uniform() < 0.05) execution.run();
      ASSERT_TRUE(execution.step(world.sim));
      fastest = std::max(fastest, world.sim.arm_state(robot.arm).v.cwiseAbs().maxCoeff());
      ASSERT_LT((execution.clock().q_ref() - world.q()).cwiseAbs().maxCoeff(), 1e-6);
    }
    ASSERT_EQ(execution.state(), State::done);
    EXPECT_GT(stops, 0);
    EXPECT_LT((world.q() - straight.q()).norm(), 1e-6);
    EXPECT_EQ(execution.outcome().reached, 2U);
    EXPECT_LT(fastest, 1.05) << "0.3 rad in 0.6 s by a quintic: 0.94 rad/s, braked or not";
  }
}

TEST(Execution, HoldsTheArmWhereItWasStopped) {
  World world(load_text(small_world()));
  const MotionPlan plan = there_and_half_back(world.robot.arm);
  Execution execution = Execution::create(world.robot.model, plan).value();
  execution.run();
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(execution.step(world.sim));
  execution.stop();
  EXPECT_EQ(execution.state(), State::stopping);
  for (int i = 0; i < MotionClock::kBrakeSteps; ++i) ASSERT_TRUE(execution.step(world.sim));
  EXPECT_EQ(execution.state(), State::stopped);
  const JointVec q = world.q();
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(execution.step(world.sim));
  EXPECT_LT((world.q() - q).norm(), 1e-6);
  EXPECT_GT((q - plan.q_start).norm(), 0.01);
}

TEST(Execution, StopsWhenAsked) {
  World world(load_text(small_world()));
  int calls = 0;
  const auto outcome =
      world.run(there_and_half_back(world.robot.arm), {}, [&](const Sim&) { return ++calls < 10; });
  ASSERT_TRUE(outcome);
  EXPECT_TRUE(outcome->stopped);
  EXPECT_EQ(outcome->steps, 10);
  EXPECT_EQ(outcome->reached, 0U);
  EXPECT_GT(outcome->torque_use, 0);
}

TEST(Execution, TellsTheFirstContactOfTheArmOnly) {
  World world(load_text(small_world()));
  JointVec into_floor = world.robot.arm.home;
  into_floor << 1.1, 0.2;
  const auto outcome = world.run(
      MotionPlan::of(world.robot.arm, rest_to_rest(world.robot.arm.home, into_floor, 1)), {});
  ASSERT_TRUE(outcome);
  ASSERT_TRUE(outcome->first_contact);
  EXPECT_EQ(outcome->first_contact->contact.first, "floor");
  EXPECT_EQ(outcome->first_contact->contact.second, "lower");
  EXPECT_GT(outcome->first_contact->time, 0.3);
  EXPECT_LT(outcome->first_contact->time, 1.0);
}

TEST(Execution, WhatOverlapsByDesignIsNoContact) {
  World world(load_text(small_world("integrator=\"implicitfast\"", "400",
                                    R"(<geom name="knob" type="sphere" size="0.1" pos="0 0 0.6"
                                       friction="0 0 0"/>)")));
  const auto outcome = world.run(there_and_half_back(world.robot.arm), {});
  ASSERT_TRUE(outcome);
  EXPECT_FALSE(outcome->first_contact) << outcome->first_contact->contact.second;
}

TEST(Execution, WhatTheArmDoesNotMoveAgainstEachOtherIsNoContact) {
  // Two balls on a link that slide into each other, as the fingers of another hand do.
  const auto ball = [](const char* name, const char* y) {
    return std::string("<body name=\"") + name + "\" pos=\"0.2 " + y +
           R"( 0"><joint type="slide" axis="0 1 0" range="-0.5 0.5"/><geom size="0.05"/></body>)";
  };
  std::string text = small_world();
  text.insert(text.find("<body name=\"lower\""), ball("one", "0.2") + ball("two", "0.29"));
  text.insert(text.find("1\" ctrl="), "0 0 ");  // of the keyframe
  World world(load_text(text));
  ASSERT_EQ(world.sim.contacts(world.robot.arm).size(), 1U);
  const auto outcome = world.run(there_and_half_back(world.robot.arm), {});
  ASSERT_TRUE(outcome);
  EXPECT_FALSE(outcome->first_contact) << outcome->first_contact->contact.second;
}

TEST(Execution, TheGripperKeepsWhatItWasToldUntilItIsToldAnew) {
  World world(load_shipped("panda"));
  const GripperDrive gripper = world.robot.arm.gripper->drives.front();
  const auto ctrl = [&] { return world.sim.ctrl()[static_cast<std::size_t>(gripper.id)]; };
  world.sim.set_ctrl(gripper.id, 77);
  const JointVec home = world.robot.arm.home;
  MotionPlan plan = MotionPlan::of(world.robot.arm, rest_to_rest(home, shifted(home, 0.1), 0.2));
  ASSERT_TRUE(world.run(plan, {}));
  EXPECT_EQ(ctrl(), 77);
  // It closes from the beginning of its motion on, at once where that takes no time.
  for (const double seconds : {0.0, 0.1}) {
    const JointState there = JointState::at_rest(shifted(home, 0.1));
    plan.moves.resize(1);
    plan.moves.push_back({.trajectory = seconds > 0 ? rest_to_rest(there.q, there.q, seconds)
                                                    : Trajectory::through({0.0}, {there}).value(),
                          .close = true});
    plan.moves.push_back({.trajectory = rest_to_rest(there.q, home, 0.2), .close = std::nullopt});
    world.sim.set_ctrl(gripper.id, 77);
    Execution execution = Execution::create(world.robot.model, plan).value();
    execution.run_one();
    while (execution.state() == State::running) ASSERT_TRUE(execution.step(world.sim));
    EXPECT_EQ(ctrl(), 77);
    execution.run_one();
    ASSERT_TRUE(execution.step(world.sim));
    EXPECT_EQ(ctrl() == gripper.ctrl_closed, seconds == 0) << ctrl();
    EXPECT_LT(std::abs(ctrl() - gripper.ctrl_closed), std::abs(77 - gripper.ctrl_closed));
    ASSERT_TRUE(execution.run_to_end(world.sim));
    EXPECT_EQ(ctrl(), gripper.ctrl_closed) << seconds;
  }
}

TEST(Execution, InstabilityIsAFailureThatSaysSo) {
  World world(load_text(small_world("timestep=\"0.05\" integrator=\"Euler\"", "20000")));
  const auto outcome = world.run(
      MotionPlan::of(world.robot.arm, rest_to_rest(world.robot.arm.home, JointVec::Zero(2), 9)),
      {.control = ControlMode::servo});
  ASSERT_FALSE(outcome);
  EXPECT_THAT(outcome.error().what, HasSubstr("unstable"));
}

TEST(Execution, WhatTheArmCannotDoIsRefusedBeforeAnythingMoves) {
  World world(load_text(small_world()));
  const JointVec seven = JointVec::Zero(7);
  MotionPlan other = MotionPlan::of(world.robot.arm, rest_to_rest(seven, seven, 1));
  const auto by_other = world.run(other, {});
  ASSERT_FALSE(by_other);
  EXPECT_EQ(by_other.error().code, Errc::usage);
  EXPECT_THAT(by_other.error().what, HasSubstr("7 joints"));
  MotionPlan grip = there_and_half_back(world.robot.arm);
  grip.moves.back().close = true;
  const auto without = world.run(grip, {});
  ASSERT_FALSE(without);
  EXPECT_EQ(without.error().code, Errc::not_available);
  world.robot.arm.joints.front().actuator.reset();
  EXPECT_FALSE(world.run(there_and_half_back(world.robot.arm), {}));
  EXPECT_EQ(world.sim.time(), 0);
}

TEST(Execution, APlanThatTakesNoTimeIsDoneAndAsksNobody) {
  World world(load_shipped("ur5e"));
  const JointVec home = world.robot.arm.home;
  const MotionPlan plan =
      MotionPlan::of(world.robot.arm, *Trajectory::through({0.0}, {JointState::at_rest(home)}));
  int asked = 0;
  const auto outcome = world.run(plan, {.rest = 0}, [&](const Sim&) {
    ++asked;
    return false;
  });
  ASSERT_TRUE(outcome) << outcome.error().what;
  EXPECT_EQ(asked, 0);
  EXPECT_EQ(outcome->steps, 0);
  EXPECT_FALSE(outcome->stopped);
  EXPECT_EQ(world.q(), home);
}

TEST(Execution, APlanWithoutMotionsIsDone) {
  World world(load_text(small_world()));
  MotionPlan plan;
  plan.arms.push_back(world.robot.arm);
  plan.q_start = world.robot.arm.home;
  const auto outcome = world.run(plan, {});
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->steps, 0);
  EXPECT_EQ(plan.q_end(), plan.q_start);
  EXPECT_EQ(plan.duration(), 0);
}

}  // namespace
}  // namespace mjarm
