// Looking back at what a program did.
#include <gtest/gtest.h>

#include "mjarm/session/program_player_test.hpp"

namespace mjarm::session {
namespace {

TEST(ProgramRecord, ScrubbingShowsWhatWasToTheLastBit) {
  ProgramPlayer world = new_player();
  press_item(world, kProgramTime, 0.5);  // nothing was recorded yet
  EXPECT_EQ(world.look(), ProgramLook::present);
  press_item(world, kProgramRun);
  std::vector<std::vector<double>> seen = {world.sim().snapshot().state};
  const double timestep = there_and_back().robot.model.timestep();
  for (int i = 0; i < 900; ++i) {
    world.step();
    seen.push_back(world.sim().snapshot().state);
  }
  for (const int i : {0, 1, 7, 450, 899, 900, 20}) {
    press_item(world, kProgramTime, (i + 0.3) * timestep);
    EXPECT_EQ(world.look(), ProgramLook::past);
    ASSERT_EQ(state_shown(world), seen[static_cast<std::size_t>(i)]) << i;
    EXPECT_NEAR(world.facts().shown, i * timestep, 1e-9);
  }
  press_item(world, kProgramTime, 1e9);
  EXPECT_EQ(state_shown(world), seen.back());
  press_item(world, kProgramTime, -1);
  EXPECT_EQ(state_shown(world), seen.front());
  press_item(world, kProgramNow);
  EXPECT_EQ(world.look(), ProgramLook::present);
  EXPECT_EQ(state_shown(world), seen.back());
}

TEST(ProgramRecord, TheSimulationWaitsWhileSomebodyLooksBack) {
  ProgramPlayer plain = new_player(), curious = new_player();
  for (ProgramPlayer* world : {&plain, &curious}) {
    press_item(*world, kProgramRun);
    make_steps(*world, 500);
  }
  press_item(curious, kProgramTime, 0.2);
  EXPECT_EQ(curious.steps_due(), 0);
  make_steps(curious, 50);
  press_item(curious, kProgramReplay);
  make_steps(curious, 30);
  curious.handle(view::PushEvent{.body = 5, .force_W = {0, 0, 500}});
  curious.handle(view::StepEvent{-1});
  EXPECT_EQ(curious.look(), ProgramLook::past);
  press_item(curious, kProgramNow);
  for (int i = 0; i < 300; ++i) {
    plain.step();
    curious.step();
    ASSERT_EQ(state_shown(curious), state_shown(plain)) << i;
  }
  // Run from the past goes on from now, and so does letting time go on.
  press_item(curious, kProgramTime, 0.1);
  press_item(curious, kProgramRun);
  EXPECT_EQ(state_shown(curious), state_shown(plain));
  press_item(curious, kProgramTime, 0.1);
  curious.handle(view::PauseEvent{false});
  EXPECT_EQ(state_shown(curious), state_shown(plain));
}

TEST(ProgramRecord, ReplayShowsAllOfTheRecord) {
  ProgramPlayer world = new_player();
  press_item(world, kProgramReplay);
  EXPECT_EQ(world.look(), ProgramLook::present);
  press_item(world, kProgramRun);
  std::vector<std::vector<double>> seen = {world.sim().snapshot().state};
  for (int i = 0; i < 300; ++i) {
    world.step();
    seen.push_back(world.sim().snapshot().state);
  }
  press_item(world, kProgramReplay);
  for (std::size_t i = 0; i < 300; ++i) {
    EXPECT_EQ(world.look(), ProgramLook::replay);
    ASSERT_EQ(state_shown(world), seen[i]) << i;
    world.step();
  }
  // It stays at the end, and begins anew from there.
  EXPECT_EQ(world.look(), ProgramLook::past);
  EXPECT_EQ(state_shown(world), seen.back());
  press_item(world, kProgramReplay);
  EXPECT_EQ(state_shown(world), seen.front());
  // From the place one looks at.
  press_item(world, kProgramTime, 0.4);
  press_item(world, kProgramReplay);
  world.step();
  EXPECT_EQ(state_shown(world), seen[201]);
}

TEST(ProgramRecord, SingleStepsGoThroughTheRecordAndOutOfIt) {
  ProgramPlayer world = new_player();
  world.handle(view::StepEvent{-1});
  EXPECT_EQ(world.look(), ProgramLook::present);
  press_item(world, kProgramRun);
  std::vector<std::vector<double>> seen = {world.sim().snapshot().state};
  for (int i = 0; i < 20; ++i) {
    world.step();
    seen.push_back(world.sim().snapshot().state);
  }
  world.handle(view::PauseEvent{true});
  for (std::size_t i = 19; i < 20; --i) {
    world.handle(view::StepEvent{-1});
    ASSERT_EQ(state_shown(world), seen[i]);
  }
  world.handle(view::StepEvent{-1});
  EXPECT_EQ(state_shown(world), seen[0]);
  for (std::size_t i = 1; i <= 20; ++i) {
    world.handle(view::StepEvent{1});
    ASSERT_EQ(state_shown(world), seen[i]);
  }
  EXPECT_EQ(world.steps_due(), 0);
  world.handle(view::StepEvent{1});
  EXPECT_EQ(world.look(), ProgramLook::present);
  EXPECT_EQ(world.steps_due(), 0);
  world.handle(view::StepEvent{1});
  EXPECT_EQ(world.steps_due(), 1);
}

TEST(ProgramRecord, ALineShowsHowItBegan) {
  ProgramPlayer world = new_player();
  press_item(world, kProgramRun);
  press_item(world, kProgramLines, 2);
  EXPECT_EQ(world.look(), ProgramLook::present);  // it did not begin yet
  steps_until(world, State::done);
  for (int line = 3; line >= 0; --line) {
    press_item(world, kProgramLines, line);
    EXPECT_EQ(world.look(), ProgramLook::past);
    EXPECT_EQ(world.facts().motion, static_cast<std::size_t>(line));
    EXPECT_LT(world.facts().time, 1e-9);
  }
  view::ViewFrame frame;
  world.fill(frame);
  const auto& items = frame.panels.at(1).items;
  const auto& list = std::get<view::PanelList>(items.back().what);
  const std::vector<std::string> lines = {"3 movej", "4 movel x2", "6 wait", "7 movej"};
  EXPECT_EQ(list.lines, lines);
  EXPECT_EQ(list.current, 0);
}

}  // namespace
}  // namespace mjarm::session
