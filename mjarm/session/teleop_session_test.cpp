#include "mjarm/session/teleop_session.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <thread>

#include "mjarm/core/file.hpp"
#include "mjarm/core/json.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/stored_zip.hpp"
#include "mjarm/session/teleop_run.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::session {
namespace {

using ::testing::HasSubstr;

constexpr int kShift = 340;

/// The Panda before its table, led without a window.
class LedPanda : public ::testing::Test {
 protected:
  TeleopSession open(bool keeps = true) {
    TeleopSessionOptions options;
    if (keeps) {
      options.keep = [this](const std::vector<episode::LedSample>& rows) -> Result<std::string> {
        kept_ = rows;
        return std::string("there");
      };
    }
    return TeleopSession::create(robot_, std::move(options)).value();
  }
  static void step(TeleopSession& session, double seconds) {
    const int periods = static_cast<int>(seconds / session.period() + 0.5);
    for (int i = 0; i < periods; ++i) session.step();
  }
  static std::string status(TeleopSession& session) {
    view::ViewFrame frame;
    session.fill(frame);
    return frame.status;
  }
  Robot robot_ = load_robot("franka_emika_panda/pick.xml").value();
  std::vector<episode::LedSample> kept_;
  LanguageScope english_{Language::english};
};

TEST_F(LedPanda, KeysLeadTheToolAndShiftIsSlow) {
  TeleopSession session = open();
  TeleopKeys keys(session.desk());
  const Pose before = session.sim().tool(robot_.arm);
  EXPECT_TRUE(keys.handle({.key = 'Q'}));
  EXPECT_TRUE(keys.handle({.key = 'Q', .repeat = true}));
  step(session, 0.5);
  EXPECT_TRUE(keys.handle({.key = 'Q', .pressed = false}));
  step(session, 0.3);
  const double fast = session.sim().tool(robot_.arm).p.z() - before.p.z();
  EXPECT_NEAR(fast, 0.125, 0.02);
  (void)keys.handle({.key = kShift});
  (void)keys.handle({.key = 'E', .shift = true});
  step(session, 0.5);
  (void)keys.handle({.key = -1, .pressed = false});
  step(session, 0.3);
  EXPECT_NEAR(session.sim().tool(robot_.arm).p.z() - before.p.z(), fast - 0.25 * 0.125, 0.01);
  EXPECT_FALSE(keys.handle({.key = 'A', .control = true})) << "Ctrl-A is the window's";
  EXPECT_FALSE(keys.handle({.key = 'M'}));
}

TEST_F(LedPanda, RecordsGoesBackAndKeeps) {
  TeleopSession session = open();
  session.desk().act(TeleopAction::record);
  session.desk().set(TeleopDesk::keys, {.linear = {0, 0, 0.2}});
  step(session, 2);
  EXPECT_NEAR(session.recorded(), 2, 0.1);
  EXPECT_THAT(status(session), HasSubstr("recording 2.0 s"));
  const JointVec there = session.sim().arm_state(robot_.arm).q;
  session.desk().set(TeleopDesk::keys, {.linear = {0, 0.3, 0}});
  step(session, TeleopSession::kRedo);
  session.desk().act(TeleopAction::redo);
  session.desk().set(TeleopDesk::keys, {});
  step(session, session.period());
  EXPECT_NEAR(session.sim().time(), 2, 0.11);
  EXPECT_NEAR(session.recorded(), 2, 0.15);
  EXPECT_LT((session.sim().arm_state(robot_.arm).q - there).cwiseAbs().maxCoeff(), 0.02);
  session.desk().act(TeleopAction::keep);
  step(session, session.period());
  ASSERT_GE(kept_.size(), 38U);
  for (std::size_t i = 1; i < kept_.size(); ++i) {
    EXPECT_GT(kept_[i].world.time, kept_[i - 1].world.time);
  }
  EXPECT_EQ(session.recorded(), 0);
  EXPECT_THAT(status(session), HasSubstr("kept in there"));
}

TEST_F(LedPanda, ARecordingRestsAndIsDiscarded) {
  TeleopSession session = open();
  session.desk().act(TeleopAction::record);
  step(session, 0.5);
  session.desk().act(TeleopAction::record);
  step(session, 0.5);
  EXPECT_NEAR(session.recorded(), 0.5, 0.06);
  session.desk().act(TeleopAction::discard);
  step(session, 0.1);
  EXPECT_EQ(session.recorded(), 0);
  session.desk().act(TeleopAction::keep);
  step(session, session.period());
  EXPECT_TRUE(kept_.empty());
  EXPECT_THAT(status(session), HasSubstr("nothing is recorded yet"));
}

TEST_F(LedPanda, WithoutAFolderItSaysWhyNothingIsRecorded) {
  TeleopSession session = open(false);
  session.desk().act(TeleopAction::record);
  step(session, 0.2);
  EXPECT_EQ(session.recorded(), 0);
  EXPECT_THAT(status(session), HasSubstr("--out DIR"));
}

TEST_F(LedPanda, SaysWhatIsNear) {
  TeleopSession session = open();
  session.desk().set(TeleopDesk::keys, {.linear = {0, 0, -1}});
  step(session, 4);
  EXPECT_THAT(status(session), HasSubstr("mm"));
  EXPECT_EQ(session.state().limit, TeleopLimit::near);
}

TEST_F(LedPanda, PausesAndGoesOnByTheSameKey) {
  TeleopSession session = open();
  TeleopKeys keys(session.desk());
  (void)keys.handle({.key = 'P'});
  session.step();
  EXPECT_THAT(status(session), HasSubstr("paused"));
  EXPECT_EQ(session.steps_due(), 0);
  (void)keys.handle({.key = 'P'});
  (void)session.steps_due();
  EXPECT_EQ(status(session).find("paused"), std::string::npos);
}

TEST_F(LedPanda, InputsPlayedAgainGiveTheSameArm) {
  TeleopSession session = open();
  session.desk().set(TeleopDesk::gamepad, {.linear = {0, 0.4, 0.2}, .angular = {0, 0, 0.5}});
  step(session, 0.5);
  session.desk().act(TeleopAction::gripper);
  step(session, 1);
  const JointVec q = session.sim().arm_state(robot_.arm).q;
  std::vector<TimedInput> inputs = session.inputs();
  inputs.push_back({session.sim().time(), {}});
  const support::TempFolder folder;
  const auto report =
      play_inputs(robot_, inputs, {.out = folder.path(), .task = "wave", .fps = 10});
  ASSERT_TRUE(report) << report.error().what;
  EXPECT_TRUE(report->ok());
  // The log tells where the arm was at the end.
  const std::string log = folder.read("log.csv");
  const std::string last = log.substr(log.rfind('\n', log.size() - 2) + 1);
  std::vector<double> numbers;
  for (std::size_t at = 0; at < last.size() && numbers.size() < 15;) {
    numbers.push_back(std::stod(last.substr(at)));
    at = last.find(',', at) + 1;
  }
  EXPECT_NEAR(numbers[0], session.sim().time(), 1e-9);
  for (int k = 0; k < 7; ++k) {
    EXPECT_EQ(numbers[static_cast<std::size_t>(8 + k)], q[k]) << "joint " << k;
  }
  const std::string bytes = folder.read("episode_000000.zip");
  const StoredZip zip = StoredZip::open(bytes, "episode").value();
  const auto about = JsonObject::parse(zip.read_checked("episode.json").value());
  ASSERT_TRUE(about);
  EXPECT_EQ((*about)->find("task")->string(), "teleop");
  EXPECT_EQ((*about)->find("language")->find("en")->string(), "wave");
  EXPECT_TRUE(zip.contains("action_tool.npy"));
  EXPECT_TRUE(zip.contains("object_poses.npy"));
}

TEST(TeleopDevices, AGamepadHasADeadZoneAndAllSixAxes) {
  view::GamepadState state;
  state.axes = {0.1, -0.1, 0.05, 0, -1, -1};
  EXPECT_EQ(hand_of(state), HandInput());
  state.axes = {-1, -1, -1, -1, -1, 1};
  state.buttons[4] = state.buttons[11] = true;
  const HandInput all = hand_of(state);
  EXPECT_EQ(all.linear, Eigen::Vector3d(1, 1, 1));
  EXPECT_EQ(all.angular, Eigen::Vector3d(1, 1, 1));
  EXPECT_EQ(all.grip, 1);
}

TEST(TeleopDevices, AButtonActsOnceAndAPadThatGoesLetsGo) {
  TeleopDesk desk;
  TeleopGamepad pad(desk);
  view::GamepadState state;
  state.axes = {0, -1, 0, 0, -1, -1};
  pad.handle(&state);
  state.buttons[0] = true;
  pad.handle(&state);
  pad.handle(&state);
  const TeleopDesk::Taken taken = desk.take();
  EXPECT_EQ(taken.actions, std::vector<TeleopAction>{TeleopAction::gripper});
  EXPECT_EQ(taken.hand.linear.x(), 1);
  EXPECT_TRUE(taken.since);
  pad.handle(nullptr);
  EXPECT_EQ(desk.take().hand, HandInput());
}

TEST(TeleopDevices, ASpaceMouseMovesAsItsCap) {
  EXPECT_EQ(hand_of_space_mouse({0, 0, 350, 0, 0, 0}).linear, Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(hand_of_space_mouse({-350, 0, 0, 0, 0, 0}).linear, Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(hand_of_space_mouse({0, 700, 0, 0, 0, 0}).linear, Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(hand_of_space_mouse({0, 0, 0, 0, 175, 0}).angular, Eigen::Vector3d(0, 0, 0.5));
}

TEST(TeleopDesk, SumsDevicesAndTellsTheFirstChange) {
  TeleopDesk desk;
  EXPECT_FALSE(desk.take().since);
  desk.set(TeleopDesk::keys, {.linear = {0.8, 0, 0}});
  desk.set(TeleopDesk::gamepad, {.linear = {0.8, -0.5, 0}, .grip = -1});
  const TeleopDesk::Taken taken = desk.take();
  EXPECT_EQ(taken.hand.linear, Eigen::Vector3d(1, -0.5, 0));
  EXPECT_EQ(taken.hand.grip, -1);
  EXPECT_TRUE(taken.since);
  desk.set(TeleopDesk::keys, {.linear = {0.8, 0, 0}});
  EXPECT_FALSE(desk.take().since) << "nothing changed";
}

}  // namespace
}  // namespace mjarm::session
