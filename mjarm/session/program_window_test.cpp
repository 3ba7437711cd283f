// A program in a real window, driven with the mouse.
#include <gtest/gtest.h>

#include "mjarm/session/program_player_test.hpp"
#include "mjarm/view/real_window_test.hpp"

namespace mjarm::session {
namespace {

constexpr const char* kWaves = R"(robot: ur5e
program:
  - movej: {joints: [-1.3, -1.5708, 1.5708, -1.5708, -1.5708, 0], speed: 0.3}
  - wait: 300ms
  - movej: {joints: [-1.5708, -1.3, 1.5708, -1.5708, -1.5708, 0], speed: 0.3}
  - movej: {joints: home}
)";

program::LoadedProgram waves() {
  const support::TempFolder folder;
  return program::load_program(folder.write("waves.yaml", kWaves).string()).value();
}

class ProgramWindow : public mjarm::testing::RealWindow {
 protected:
  ProgramWindow() { model_ = loaded_.robot.model; }
  view::WindowOptions options() override {
    return {.width = 800,
            .height = 700,
            .quality = render::RenderQuality::low,
            .right_panel = true,
            .joints_open = false};
  }
  void SetUp() override {
    RealWindow::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    EXPECT_TRUE(until([this] { return window_->item_spot(false, 1, 0).has_value(); }));
  }

  /// Lets window and player live until something holds, at most so many seconds.
  bool until(const std::function<bool()>& holds, double seconds = 20) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end) {
      for (const view::ViewEvent& event : window_->take_events()) player_.handle(event);
      for (int due = player_.steps_due(); due > 0; --due) player_.step();
      player_.fill(frame_);
      window_->set_status(frame_.status);
      const Result<void> drawn =
          window_->draw(frame_.snapshot, frame_.overlay, frame_.plots, frame_.panels);
      if (!drawn) ADD_FAILURE() << drawn.error().what;
      if (holds()) return true;
    }
    return holds();
  }
  /// Clicks on an item, again where the click got lost on a busy machine.
  bool click(int section, int number, const std::function<bool()>& holds) {
    for (int attempt = 0; attempt < 4; ++attempt) {
      const auto spot = window_->item_spot(false, section, number);
      if (!spot) return false;
      xdotool({"mousemove", std::to_string(static_cast<int>(spot->x)),
               std::to_string(static_cast<int>(spot->y)), "click", "1"});
      if (until(holds, 5)) return true;
    }
    return false;
  }
  bool click(ProgramItem wanted, const std::function<bool()>& holds) {
    for (std::size_t section = 0; section < frame_.panels.size(); ++section) {
      const auto& items = frame_.panels[section].items;
      for (std::size_t i = 0; i < items.size(); ++i) {
        if (items[i].id != wanted) continue;
        return click(static_cast<int>(section) + 1, static_cast<int>(i), holds);
      }
    }
    return false;
  }
  [[nodiscard]] State state() const { return player_.clock().state(); }
  [[nodiscard]] bool is(State wanted, ProgramLook look = ProgramLook::present) const {
    return state() == wanted && player_.look() == look;
  }

  program::LoadedProgram loaded_ = waves();
  ProgramPlayer player_ = ProgramPlayer::create(loaded_).value();
  view::ViewFrame frame_;
};

TEST_F(ProgramWindow, RunStopStepRestart) {
  EXPECT_TRUE(is(State::ready));
  player_.handle(view::SpeedEvent{0.2});  // so that a click may get lost and be repeated
  ASSERT_TRUE(click(kProgramRun, [this] { return is(State::running); }));
  EXPECT_TRUE(until([this] { return player_.facts().recorded > 0.1; }));
  ASSERT_TRUE(click(kProgramStop, [this] { return state() != State::running; }));
  EXPECT_TRUE(until([this] { return is(State::stopped); }));
  const JointVec q = player_.clock().q_ref();
  until([] { return false; }, 0.2);
  EXPECT_EQ(player_.clock().q_ref(), q);
  // The rest of the motion, and no more.
  const std::size_t motion = player_.clock().motion();
  ASSERT_TRUE(click(kProgramStep, [&] { return player_.clock().motion() == motion + 1; }));
  EXPECT_TRUE(is(State::stopped));
  ASSERT_TRUE(click(kProgramRun, [this] { return state() == State::running; }));
  player_.handle(view::SpeedEvent{4});
  EXPECT_TRUE(until([this] { return is(State::done); }, 60));
  const Trajectory& last = loaded_.plan.moves.back().trajectory;
  EXPECT_EQ(player_.clock().q_ref(), last.at(last.duration()).q);
  ASSERT_TRUE(click(kProgramRestart, [this] { return is(State::ready); }));
  EXPECT_EQ(player_.clock().q_ref(), loaded_.plan.q_start);
}

TEST_F(ProgramWindow, ScrubReplayNowAndLines) {
  player_.handle(view::SpeedEvent{4});
  ASSERT_TRUE(click(kProgramRun, [this] { return state() == State::running; }));
  ASSERT_TRUE(until([this] { return is(State::done); }, 60));
  const double all = player_.facts().recorded;
  const double end = player_.facts().expected;
  const double present = frame_.snapshot.time;
  EXPECT_NEAR(all, end, 0.01);
  // The middle of the line is half of the time.
  ASSERT_TRUE(click(kProgramTime, [this] { return is(State::done, ProgramLook::past); }));
  EXPECT_NEAR(player_.facts().shown, 0.5 * end, 0.03 * end);
  EXPECT_LT(frame_.snapshot.time, present - 0.4 * end);
  // Replay goes on from there to the end.
  player_.handle(view::SpeedEvent{0.5});
  const double from = player_.facts().shown;
  ASSERT_TRUE(click(kProgramReplay, [this] { return player_.look() == ProgramLook::replay; }));
  EXPECT_TRUE(until([&] { return player_.facts().shown > from + 0.2; }));
  EXPECT_TRUE(until([this] { return player_.look() == ProgramLook::past; }, 60));
  EXPECT_EQ(player_.facts().shown, all);
  ASSERT_TRUE(click(kProgramNow, [this] { return player_.look() == ProgramLook::present; }));
  // The middle of four lines is the third.
  ASSERT_TRUE(click(kProgramLines, [this] { return player_.look() == ProgramLook::past; }));
  EXPECT_EQ(player_.facts().motion, 2U);
}

TEST_F(ProgramWindow, KeysPauseAndStepThroughTheRecord) {
  player_.handle(view::SpeedEvent{0.2});
  ASSERT_TRUE(click(kProgramRun, [this] { return state() == State::running; }));
  ASSERT_TRUE(until([this] { return player_.facts().recorded > 0.1; }));
  // Of the picture, not of the panel.
  xdotool({"mousemove", "200", "300"});
  const auto key = [this](const char* name, const std::function<bool()>& holds) {
    for (int attempt = 0; attempt < 4; ++attempt) {
      xdotool({"key", name});
      if (until(holds, 5)) return true;
    }
    return false;
  };
  ASSERT_TRUE(key("Left", [this] { return player_.look() == ProgramLook::past; }));
  EXPECT_TRUE(window_->paused());
  const double looked = player_.facts().shown;
  EXPECT_LT(looked, player_.facts().recorded);
  ASSERT_TRUE(key("Left", [&] { return player_.facts().shown < looked; }));
  ASSERT_TRUE(key("space", [this] { return is(State::running); }));
  ASSERT_TRUE(key("BackSpace", [this] { return is(State::ready); }));
}

TEST_F(ProgramWindow, CheckBoxesChoose) {
  ASSERT_TRUE(click(kProgramGoal, [this] { return player_.choice().goal; }));
  EXPECT_EQ(frame_.overlay.ghosts.size(), 1U);
  ASSERT_TRUE(click(kProgramPaths, [this] { return !player_.choice().paths; }));
  EXPECT_TRUE(frame_.overlay.lines.empty());
}

}  // namespace
}  // namespace mjarm::session
