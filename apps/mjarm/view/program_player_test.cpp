#include "apps/mjarm/view/program_player_test.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <sstream>

#include "mjarm/core/file.hpp"
#include "mjarm/core/rng.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::app {
namespace {

/// q of the arm at each time of a log.
std::map<long, std::vector<double>> joints_of_log(const std::string& csv, double timestep) {
  std::map<long, std::vector<double>> rows;
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::vector<double> numbers;
    std::istringstream fields(line);
    for (std::string field; numbers.size() < 13 && std::getline(fields, field, ',');) {
      numbers.push_back(std::stod(field));
    }
    rows[std::lround(numbers[0] / timestep)] = {numbers.begin() + 7, numbers.end()};
  }
  return rows;
}

TEST(ProgramPlayer, RunsAsMjarmRunDoes) {
  const support::TempFolder folder;
  const std::string file = folder.write("there.yaml", kThereAndBack).string();
  const auto out = folder.path() / "out";
  const support::ProgramResult ran =
      support::run_program(MJARM_PROGRAM, {"run", file, "--headless", "--out", out.string()});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const double timestep = there_and_back().robot.model.timestep();
  const auto log = joints_of_log(read_file(out / "log.csv").value(), timestep);

  ProgramPlayer world = new_player();
  press_item(world, kProgramRun);
  long step = 0;
  double worst = 0;
  while (world.walk().state() == State::running) {
    world.step();
    const auto row = log.find(++step);
    ASSERT_NE(row, log.end()) << step;
    const JointVec q = world.sim().arm_state(there_and_back().robot.arm).q;
    worst = std::max(worst, (q - joint_vec(row->second)).cwiseAbs().maxCoeff());
  }
  EXPECT_EQ(world.walk().state(), State::done);
  EXPECT_EQ(static_cast<std::size_t>(step) + 1, log.size());
  EXPECT_LT(worst, 1e-12);
}

TEST(ProgramPlayer, StepStopsAtTheEndOfEachMotion) {
  ProgramPlayer world = new_player();
  const ProgramPlan& plan = there_and_back().plan;
  ASSERT_EQ(plan.moves.size(), 4U);
  make_steps(world, 20);
  EXPECT_EQ(world.walk().state(), State::ready);
  for (std::size_t i = 0; i < plan.moves.size(); ++i) {
    EXPECT_EQ(world.facts().motion, i);
    press_item(world, kProgramStep);
    steps_until(world, i + 1 < plan.moves.size() ? State::stopped : State::done);
    const Trajectory& way = plan.moves[i].trajectory;
    EXPECT_EQ(world.walk().q_ref(), way.at(way.duration()).q);
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
  EXPECT_EQ(world.walk().state(), State::stopping);
  EXPECT_LE(steps_until(world, State::stopped), PlanWalk::kBrakeSteps);
  make_steps(world, 200);
  const JointState rest = world.sim().arm_state(there_and_back().robot.arm);
  EXPECT_LT(rest.v.cwiseAbs().maxCoeff(), 1e-6);
  press_item(world, kProgramRun);
  double worst = 0;
  while (world.walk().state() == State::running) {
    world.step();
    const JointVec q = world.sim().arm_state(there_and_back().robot.arm).q;
    worst = std::max(worst, (q - world.walk().q_ref()).cwiseAbs().maxCoeff());
  }
  EXPECT_EQ(world.walk().state(), State::done);
  EXPECT_LT(worst, 1e-6);  // the controller follows all the way: nothing jumped
}

/// Who looks back changes nothing of what comes.
TEST(ProgramPlayer, RestartBeginsAnew) {
  ProgramPlayer world = new_player();
  const std::vector<double> first = state_shown(world);
  press_item(world, kProgramRun);
  make_steps(world, 300);
  const std::vector<double> later = state_shown(world);
  for (const ViewEvent& event :
       {ViewEvent{ResetEvent{}}, ViewEvent{PanelEvent{kProgramRestart, 1}}}) {
    world.handle(PushEvent{.body = 4, .force_W = {5, 0, 0}});
    make_steps(world, 40);
    press_item(world, kProgramTime, 0.1);
    world.handle(event);
    EXPECT_EQ(world.look(), ProgramLook::present);
    EXPECT_EQ(world.walk().state(), State::ready);
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
  ViewFrame frame;
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
    world.handle(PanelEvent{kProgramFigure + i, 1});
  }
  world.fill(frame);
  EXPECT_EQ(frame.plots.size(), kLiveFigures);
  EXPECT_EQ(frame.overlay.lines.size(), lines - 1);
  ASSERT_EQ(frame.overlay.ghosts.size(), 1U);
  const Trajectory& way = there_and_back().plan.moves[world.walk().motion()].trajectory;
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
  const LoadedProgram loaded = load_program(folder
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
  ProgramPlayer world = ProgramPlayer::make(loaded).value();
  const Gripper& gripper = *loaded.robot.arm.gripper;
  const auto ctrl = [&] { return world.sim().ctrl()[static_cast<std::size_t>(gripper.id)]; };
  press_item(world, kProgramRun);
  make_steps(world, 5);
  EXPECT_EQ(ctrl(), gripper.ctrl_open);
  steps_until(world, State::done);
  EXPECT_EQ(ctrl(), gripper.ctrl_closed);
  press_item(world, kProgramRestart);
  press_item(world, kProgramStep);
  steps_until(world, State::stopped);
  EXPECT_EQ(world.walk().motion(), 1U);
  EXPECT_EQ(ctrl(), gripper.ctrl_open);
}

ViewEvent any_event(Rng& rng) {
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
      return PauseEvent{rng.below(2) == 0};
    case 1:
      return StepEvent{rng.below(2) == 0 ? 1 : -1};
    case 2:
      return PushEvent{.body = static_cast<int>(rng.below(7)), .force_W = {rng.uniform(), 0, 0}};
    case 3:
      return ReleaseEvent{};
    case 4:
      return rng.below(20) == 0 ? ViewEvent{ResetEvent{}} : ViewEvent{SelectEvent{}};
    default:
      if (rng.below(10) != 0 && rng.below(3) == 0) return PanelEvent{kProgramRun, 1};
      return PanelEvent{static_cast<int>(rng.below(kProgramFigure + 8)) - 1, kOdd[rng.below(8)]};
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
    done += world.walk().state() == State::done ? 1 : 0;
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
}  // namespace mjarm::app
