#include "mjarm/session/program_player_test.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mjarm/core/rng.hpp"
#include "mjarm/execution/motion_run.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::session {
namespace {

TEST(ProgramPlayer, GoesAsARunWithoutAWindowDoes) {
  const program::LoadedProgram& loaded = there_and_back();
  std::vector<JointVec> q;
  MotionRun run(loaded.robot.model, loaded.robot.arm);
  run.set_after_step([&](const Sim& sim, MotionPart) {
    q.push_back(sim.arm_state(loaded.robot.arm).q);
    return true;
  });
  ASSERT_TRUE(run.execute(loaded.plan, ControlMode::computed_torque));

  ProgramPlayer world = new_player();
  press_item(world, kProgramRun);
  std::size_t step = 0;
  while (world.clock().state() == State::running) {
    world.step();
    ASSERT_LT(step, q.size());
    ASSERT_EQ(world.sim().arm_state(loaded.robot.arm).q, q[step++]) << step;
  }
  EXPECT_EQ(world.clock().state(), State::done);
  EXPECT_EQ(step, q.size());
}

TEST(ProgramPlayer, StepStopsAtTheEndOfEachMotion) {
  ProgramPlayer world = new_player();
  const program::ProgramPlan& plan = there_and_back().plan;
  ASSERT_EQ(plan.moves.size(), 4U);
  make_steps(world, 20);
  EXPECT_EQ(world.clock().state(), State::ready);
  for (std::size_t i = 0; i < plan.moves.size(); ++i) {
    EXPECT_EQ(world.facts().motion, i);
    press_item(world, kProgramStep);
    steps_until(world, i + 1 < plan.moves.size() ? State::stopped : State::done);
    const Trajectory& way = plan.moves[i].trajectory;
    EXPECT_EQ(world.clock().q_ref(), way.at(way.duration()).q);
    make_steps(world, 100);
    const JointVec q = world.sim().arm_state(there_and_back().robot.arm).q;
    EXPECT_LT((q - way.at(way.duration()).q).cwiseAbs().maxCoeff(), 1e-6);
  }
}

TEST(ProgramPlayer, StopComesToRestAndRunGoesOn) {
  ProgramPlayer world = new_player();
  press_item(world, kProgramRun);
  make_steps(world, 400);
  press_item(world, kProgramStop);
  EXPECT_EQ(world.clock().state(), State::stopping);
  EXPECT_LE(steps_until(world, State::stopped), MotionClock::kBrakeSteps);
  make_steps(world, 200);
  const JointState rest = world.sim().arm_state(there_and_back().robot.arm);
  EXPECT_LT(rest.v.cwiseAbs().maxCoeff(), 1e-6);
  press_item(world, kProgramRun);
  double worst = 0;
  while (world.clock().state() == State::running) {
    world.step();
    const JointVec q = world.sim().arm_state(there_and_back().robot.arm).q;
    worst = std::max(worst, (q - world.clock().q_ref()).cwiseAbs().maxCoeff());
  }
  EXPECT_EQ(world.clock().state(), State::done);
  EXPECT_LT(worst, 1e-6);  // the controller follows all the way: nothing jumped
}

/// Who looks back changes nothing of what comes.
TEST(ProgramPlayer, RestartBeginsAnew) {
  ProgramPlayer world = new_player();
  const std::vector<double> first = state_shown(world);
  press_item(world, kProgramRun);
  make_steps(world, 300);
  const std::vector<double> later = state_shown(world);
  for (const view::ViewEvent& event : {view::ViewEvent{view::ResetEvent{}},
                                       view::ViewEvent{view::PanelEvent{kProgramRestart, 1}}}) {
    world.handle(view::PushEvent{.body = 4, .force_W = {5, 0, 0}});
    make_steps(world, 40);
    press_item(world, kProgramTime, 0.1);
    world.handle(event);
    EXPECT_EQ(world.look(), ProgramLook::present);
    EXPECT_EQ(world.clock().state(), State::ready);
    EXPECT_EQ(world.facts().recorded, 0);
    EXPECT_EQ(state_shown(world), first);
    press_item(world, kProgramRun);
    make_steps(world, 300);
    EXPECT_EQ(state_shown(world), later);
  }
}

TEST(ProgramPlayer, WhatIsShownIsChosen) {
  ProgramPlayer world = new_player();
  make_steps(world, 40);
  view::ViewFrame frame;
  world.fill(frame);
  EXPECT_TRUE(frame.plots.empty());
  press_item(world, kProgramRun);
  make_steps(world, 400);
  world.fill(frame);
  ASSERT_EQ(frame.plots.size(), 2U);
  // Figures begin when the time line does.
  EXPECT_EQ(frame.plots[0].series[0].x.front(), 0);
  EXPECT_NEAR(frame.plots[0].series[0].x.back(), world.facts().recorded, 0.01);
  const std::size_t lines = frame.overlay.lines.size();
  EXPECT_GE(lines, 4U);  // three paths and a trail
  EXPECT_TRUE(frame.overlay.ghosts.empty());
  press_item(world, kProgramGoal, 1);
  press_item(world, kProgramTrail, 0);
  for (int i = 0; i < static_cast<int>(kLiveFigures); ++i) {
    world.handle(view::PanelEvent{kProgramFigure + i, 1});
  }
  world.fill(frame);
  EXPECT_EQ(frame.plots.size(), kLiveFigures);
  EXPECT_EQ(frame.overlay.lines.size(), lines - 1);
  ASSERT_EQ(frame.overlay.ghosts.size(), 1U);
  const Trajectory& way = there_and_back().plan.moves[world.clock().motion()].trajectory;
  EXPECT_EQ(joint_vec(frame.overlay.ghosts[0].qpos), way.at(way.duration()).q);
  press_item(world, kProgramTime, 0.2);  // the past has no goal
  world.fill(frame);
  EXPECT_TRUE(frame.overlay.ghosts.empty());
  press_item(world, kProgramPaths, 0);
  world.fill(frame);
  EXPECT_TRUE(frame.overlay.lines.empty());
}

TEST(ProgramPlayer, GripsWhereTheProgramSaysSo) {
  const support::TempFolder folder;
  const program::LoadedProgram loaded =
      program::load_program(folder
                                .write("grip.yaml", R"(robot: panda
program:
  - grip: open
  - movej: {joints: [0, 0.1, 0, -1.57, 0, 1.57, -0.78]}
  - grip: close
  - wait: 200ms
)")
                                .string())
          .value();
  ASSERT_TRUE(loaded.plan.ok()) << loaded.plan.faults.front().what;
  ProgramPlayer world = ProgramPlayer::create(loaded).value();
  const GripperDrive& gripper = loaded.robot.arm.gripper->drives.front();
  const auto ctrl = [&] { return world.sim().ctrl()[static_cast<std::size_t>(gripper.id)]; };
  press_item(world, kProgramRun);
  make_steps(world, 5);
  EXPECT_EQ(ctrl(), gripper.ctrl_open);
  steps_until(world, State::done);
  EXPECT_EQ(ctrl(), gripper.ctrl_closed);
  press_item(world, kProgramRestart);
  press_item(world, kProgramStep);
  steps_until(world, State::stopped);
  EXPECT_EQ(world.clock().motion(), 1U);
  EXPECT_EQ(ctrl(), gripper.ctrl_open);
}

view::ViewEvent any_event(Rng& rng) {
  constexpr double kOdd[] = {0,
                             1,
                             -1,
                             0.7,
                             3,
                             1e12,
                             std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()};
  switch (rng.below(8)) {
    case 0:
      return view::PauseEvent{rng.below(2) == 0};
    case 1:
      return view::StepEvent{rng.below(2) == 0 ? 1 : -1};
    case 2:
      return view::PushEvent{.body = static_cast<int>(rng.below(7)),
                             .force_W = {rng.uniform(), 0, 0}};
    case 3:
      return view::ReleaseEvent{};
    case 4:
      return rng.below(20) == 0 ? view::ViewEvent{view::ResetEvent{}}
                                : view::ViewEvent{view::SelectEvent{}};
    default:
      if (rng.below(10) != 0 && rng.below(3) == 0) return view::PanelEvent{kProgramRun, 1};
      return view::PanelEvent{static_cast<int>(rng.below(kProgramFigure + 8)) - 1,
                              kOdd[rng.below(8)]};
  }
}

TEST(ProgramPlayer, TakesEventsInAnyOrder) {
  Rng rng(3);
  ProgramPlayer world = new_player();
  const std::size_t size = state_shown(world).size();
  int past = 0, done = 0;
  for (int i = 0; i < 20000; ++i) {
    world.handle(any_event(rng));
    make_steps(world, static_cast<int>(rng.below(12)));
    if (i % 1000 == 0) {  // now and then all of it
      press_item(world, kProgramRun);
      steps_until(world, State::done);
    }
    past += world.look() != ProgramLook::present ? 1 : 0;
    done += world.clock().state() == State::done ? 1 : 0;
    if (i % 50 != 0) continue;
    ASSERT_EQ(state_shown(world).size(), size);
    const ProgramFacts facts = world.facts();
    ASSERT_GE(facts.shown, 0);
    ASSERT_LE(facts.shown, facts.recorded);
    ASSERT_LE(facts.motion, 4U);
    ASSERT_LE(facts.time, facts.duration + 1e-9);
  }
  EXPECT_GT(past, 100);
  EXPECT_GT(done, 0);
}

}  // namespace
}  // namespace mjarm::session
