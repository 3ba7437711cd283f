// What mouse and keys do, without a window: the inputs are handed over as the window system tells
// them, so this holds on machines without a display.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "mjarm/core/rng.hpp"
#include "mjarm/view/interaction_internal.hpp"
#include "mjarm/view/ray.hpp"

namespace mjarm::view {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Kind = RawInput::Kind;

constexpr int kViewWidth = 400, kViewHeight = 300;  // [px]

/// A ball on a slide in the middle of the picture; a wall that cannot move stands at the left.
Model ball_and_wall() {
  return Model::from_mjcf(R"(<mujoco>
  <statistic center="0 0 0" extent="2"/>
  <worldbody>
    <camera name="front" pos="0 -3 0" xyaxes="1 0 0 0 0 1"/>
    <geom name="wall" type="box" size="0.2 0.2 0.5" pos="-1.2 0 0"/>
    <body name="ball"><joint name="x" type="slide" axis="1 0 0"/>
      <geom name="skin" type="sphere" size="0.4"/></body>
  </worldbody></mujoco>)")
      .value();
}

class UserTest : public ::testing::Test {
 protected:
  void SetUp() override { begin({}); }
  void begin(const Permissions& may) {
    mjr_defaultContext(&context_);
    panels_.resize(kViewWidth, kViewHeight);
    ASSERT_TRUE(scene_.set_camera({.name = "front"}));
    user_ = std::make_unique<Interaction>(scene_, panels_, may, false);
    user_->camera.begin();
    scene_.update({});
  }
  void send(Kind kind, double x, double y, int button = 0, bool control = false) {
    user_->handle(
        {.kind = kind, .x = x, .y = y, .button = button, .control = control, .time = time_ += 1},
        context_);
  }
  void drag(int button, const Vector2d& from, const Vector2d& way, int moves = 1) {
    send(Kind::press, from.x(), from.y(), button);
    for (int i = 1; i <= moves; ++i) {
      const Vector2d to = from + way * i / moves;
      send(Kind::move, to.x(), to.y());
    }
    send(Kind::release, from.x() + way.x(), from.y() + way.y(), button);
  }
  void key(int key, KeyModifier with = KeyModifier::none) {
    user_->handle({.kind = Kind::key,
                   .key = key,
                   .control = with == KeyModifier::control,
                   .shift = with == KeyModifier::shift},
                  context_);
  }
  void key_for(ViewAction action) {
    for (const ActionRow& row : action_rows()) {
      if (row.action == action) return key(row.key, row.modifier);
    }
    FAIL() << "no key";
  }
  /// The only event since the last time.
  template <class Event>
  Event event() {
    const std::vector<ViewEvent> events = user_->take_events();
    if (events.size() == 1 && std::holds_alternative<Event>(events[0])) {
      return std::get<Event>(events[0]);
    }
    ADD_FAILURE() << events.size() << " events";
    return {};
  }

  Model model_ = ball_and_wall();
  render::Scene scene_{model_, render::RenderQuality::low};
  Panels panels_{scene_.model(), {}, true, true};
  std::unique_ptr<Interaction> user_;
  mjrContext context_{};
  double time_ = 0;
  const Vector2d middle_{kViewWidth / 2.0, kViewHeight / 2.0};
};

/// The camera turns by the way of the mouse, whatever the number of events it comes in.
TEST_F(UserTest, ADragTurnsByItsWayInAnyNumberOfMoves) {
  for (const int moves : {1, 7, 60}) {
    user_->camera.to_first_view();
    const render::CameraView before = scene_.view();
    drag(0, middle_, {60, -30}, moves);
    const render::CameraView after = scene_.view();
    EXPECT_NEAR(after.azimuth - before.azimuth, -std::numbers::pi * 60 / kViewHeight, 1e-9);
    EXPECT_NEAR(after.elevation - before.elevation, -std::numbers::pi * 30 / kViewHeight, 1e-9);
    EXPECT_EQ(after.lookat_W, before.lookat_W);
  }
  // Over the pole it stops, and does not tumble.
  drag(0, middle_, {0, 5000});
  EXPECT_NEAR(scene_.view().elevation, 89.9 * std::numbers::pi / 180, 1e-9);
  drag(0, middle_, {0, -50000});
  EXPECT_NEAR(scene_.view().elevation, -89.9 * std::numbers::pi / 180, 1e-9);
  // Once round and back is where it was.
  user_->camera.to_first_view();
  const render::CameraView first = scene_.view();
  for (int i = 0; i < 10; ++i) drag(0, middle_, {2 * kViewHeight / 10.0, 0}, 3);
  EXPECT_NEAR(std::remainder(scene_.view().azimuth - first.azimuth, 2 * std::numbers::pi), 0, 1e-9);
  EXPECT_THAT(user_->take_events(), IsEmpty());
}

/// What is in the middle of the picture follows the hand.
TEST_F(UserTest, PanningTakesTheWorldAlong) {
  for (const int button : {1, 2}) {
    user_->camera.to_first_view();
    scene_.update({});
    const Vector3d seen = scene_.view().lookat_W;
    drag(button, middle_, {50, -20}, 5);
    scene_.update({});
    const auto at = pixel_of_point(eye_of(scene_), kViewWidth, kViewHeight, seen);
    ASSERT_TRUE(at);
    EXPECT_NEAR(at->x() - kViewWidth / 2.0, 50, button == 1 ? 10.1 : 0.1);
    // From above, where y of the mouse is from below. A right drag begins after its first pixels,
    // which might have been a click.
    EXPECT_NEAR(at->y() - kViewHeight / 2.0, 20, button == 1 ? 4.1 : 0.1);
  }
}

TEST_F(UserTest, TheWheelComesBackAndStopsAtBothEnds) {
  const double before = scene_.view().distance;
  const auto wheel = [&](double notches) {
    user_->handle({.kind = Kind::scroll, .x = 200, .y = 150, .notches = notches}, context_);
  };
  wheel(3);
  EXPECT_LT(scene_.view().distance, before);
  wheel(-1);
  wheel(-2);
  EXPECT_NEAR(scene_.view().distance, before, 1e-12);
  for (int i = 0; i < 300; ++i) wheel(1);
  EXPECT_NEAR(scene_.view().distance, 0.01 * 2, 1e-12);
  for (int i = 0; i < 300; ++i) wheel(-1);
  EXPECT_NEAR(scene_.view().distance, 100 * 2, 1e-9);
}

TEST_F(UserTest, ASecondButtonNeitherChangesNorEndsADrag) {
  send(Kind::press, 200, 150, 0);
  send(Kind::press, 200, 150, 1);
  const Vector3d lookat = scene_.view().lookat_W;
  send(Kind::move, 230, 150);
  EXPECT_EQ(scene_.view().lookat_W, lookat) << "it still turns";
  send(Kind::release, 230, 150, 1);
  const double azimuth = scene_.view().azimuth;
  send(Kind::move, 260, 150);
  EXPECT_NE(scene_.view().azimuth, azimuth) << "the first button is still held";
  send(Kind::release, 260, 150, 0);
  const double at_end = scene_.view().azimuth;
  send(Kind::move, 290, 150);
  EXPECT_EQ(scene_.view().azimuth, at_end);
  EXPECT_FALSE(panels_.left_shown()) << "no click of the second button";
}

TEST_F(UserTest, ARightClickShowsThePanelAndADragDoesNot) {
  drag(1, middle_, {2, 1});
  EXPECT_TRUE(panels_.left_shown());
  key_for(ViewAction::left_panel);
  EXPECT_FALSE(panels_.left_shown());
  // There and back is a drag as well, though it ends where it began.
  send(Kind::press, 200, 150, 1);
  for (const double x : {203.0, 206.0, 203.0, 200.0}) send(Kind::move, x, 150);
  send(Kind::release, 200, 150, 1);
  EXPECT_FALSE(panels_.left_shown());
}

TEST_F(UserTest, ADoubleClickSelectsWhatIsThere) {
  const auto click = [this](double x, int button, double at) {
    for (const Kind kind : {Kind::press, Kind::release}) {
      user_->handle({.kind = kind, .x = x, .y = 150, .button = button, .time = at}, context_);
    }
  };
  click(200, 0, 10);
  EXPECT_THAT(user_->take_events(), IsEmpty()) << "one click selects nothing";
  click(200, 0, 10.3);
  EXPECT_EQ(event<SelectEvent>().body_name, "ball");
  click(200, 0, 20);
  click(200, 0, 20.5);
  EXPECT_THAT(user_->take_events(), IsEmpty()) << "too slow";
  click(200, 2, 30);
  click(200, 0, 30.1);
  EXPECT_THAT(user_->take_events(), IsEmpty()) << "two buttons";
  click(398, 0, 40);
  click(398, 0, 40.1);
  EXPECT_EQ(event<SelectEvent>().body, -1) << "nothing is there, and that is told";
}

TEST_F(UserTest, AControlDragPushesUntilItIsReleased) {
  send(Kind::press, 200, 150, 1, true);
  user_->update();
  EXPECT_LT(event<PushEvent>().force_W.norm(), 1e-9);
  send(Kind::move, 240, 150, 0, true);
  user_->update();
  const auto push = event<PushEvent>();
  EXPECT_EQ(push.name, "ball");
  EXPECT_GT(push.force_W.x(), 0);
  EXPECT_EQ(scene_.camera().type, mjCAMERA_FREE);
  user_->update();
  EXPECT_EQ(event<PushEvent>().force_W, push.force_W) << "it goes on while it is held";
  send(Kind::release, 240, 150, 1);
  EXPECT_EQ(event<ReleaseEvent>().body, push.body);
  user_->update();
  EXPECT_THAT(user_->take_events(), IsEmpty());
  // A wall is not pushed, and that is said; the camera stays where it is.
  const render::CameraView before = scene_.view();
  const auto wall = pixel_of_point(eye_of(scene_), kViewWidth, kViewHeight, {-1.0, -0.2, 0});
  send(Kind::press, wall->x(), kViewHeight - wall->y(), 1, true);
  EXPECT_EQ(user_->take_said(), "there is nothing that moves");
  EXPECT_EQ(user_->take_said(), std::nullopt) << "once";
  send(Kind::move, 200, 200);
  send(Kind::release, 200, 200, 1);
  EXPECT_EQ(scene_.view().azimuth, before.azimuth);
}

TEST_F(UserTest, WhatIsNotAllowedIsSaidAndNotDone) {
  begin({.step = false, .reset = false, .push = false, .target = false});
  for (const ViewAction action :
       {ViewAction::step, ViewAction::step_back, ViewAction::reset, ViewAction::target}) {
    key_for(action);
    const std::optional<std::string> said = user_->take_said();
    ASSERT_TRUE(said.has_value()) << static_cast<int>(action);
    for (const char c : *said) EXPECT_TRUE(c >= 32 && c < 127) << "the window's font is ASCII";
  }
  send(Kind::press, 200, 150, 1, true);
  EXPECT_EQ(user_->take_said(), "pushing is off here");
  user_->update();
  EXPECT_THAT(user_->take_events(), IsEmpty());
  EXPECT_FALSE(user_->paused()) << "a step that is not made does not pause either";
}

TEST_F(UserTest, EveryActionHasItsEffect) {
  begin({.target = true});
  key_for(ViewAction::pause);
  EXPECT_TRUE(event<PauseEvent>().paused);
  key_for(ViewAction::step_back);
  EXPECT_EQ(event<StepEvent>().steps, -1) << "it is paused already: no other event";
  key_for(ViewAction::pause);
  EXPECT_FALSE(event<PauseEvent>().paused);
  key_for(ViewAction::step);
  const std::vector<ViewEvent> events = user_->take_events();
  ASSERT_EQ(events.size(), 2U);
  EXPECT_TRUE(std::get<PauseEvent>(events[0]).paused);
  EXPECT_EQ(std::get<StepEvent>(events[1]).steps, 1);
  key_for(ViewAction::reset);
  event<ResetEvent>();
  key_for(ViewAction::target);
  event<TargetEvent>();
  key_for(ViewAction::screenshot);
  EXPECT_TRUE(user_->take_screenshot());
  EXPECT_FALSE(user_->take_screenshot()) << "one picture a key";
  key_for(ViewAction::help);
  EXPECT_TRUE(user_->help_shown());
  key_for(ViewAction::help);
  EXPECT_FALSE(user_->help_shown());
  key_for(ViewAction::right_panel);
  EXPECT_TRUE(panels_.right_shown());
  EXPECT_FALSE(panels_.left_shown());
  EXPECT_FALSE(user_->close_wanted());
  key_for(ViewAction::close);
  EXPECT_TRUE(user_->close_wanted());
}

/// As often as there are names, and it is where it began.
TEST_F(UserTest, FramesLabelsAndCamerasGoRound) {
  const ViewSettings before = user_->settings;
  for (std::size_t i = 0; i < view_frame_names().size(); ++i) key_for(ViewAction::next_frame);
  for (std::size_t i = 0; i + 1 < view_label_names().size(); ++i) {
    key_for(ViewAction::next_label);
    EXPECT_EQ(user_->settings.label, static_cast<int>(i) + 1);
  }
  key_for(ViewAction::next_label);
  EXPECT_EQ(user_->settings, before);
  key_for(ViewAction::next_camera);
  EXPECT_EQ(user_->camera.name(), "front");
  key_for(ViewAction::first_view);
  EXPECT_EQ(user_->camera.name(), "");
}

TEST_F(UserTest, SpeedsGoThroughTheirListAndStopAtItsEnds) {
  std::vector<double> seen;
  for (std::size_t i = 0; i < 2 * view_speeds().size(); ++i) key_for(ViewAction::slower);
  (void)user_->take_events();
  for (std::size_t i = 0; i < 2 * view_speeds().size(); ++i) {
    key_for(ViewAction::faster);
    for (const ViewEvent& told : user_->take_events()) {
      seen.push_back(std::get<SpeedEvent>(told).speed);
      EXPECT_EQ(user_->speed(), seen.back());
    }
  }
  const std::vector<double> all(view_speeds().begin() + 1, view_speeds().end());
  EXPECT_EQ(seen, all) << "each once, and no event where nothing changes";
}

TEST_F(UserTest, AKeyOfASettingTogglesThatAloneAndTwiceIsNothing) {
  const ViewSettings before = user_->settings;
  for (const SettingRow& row : setting_rows()) {
    ViewSettings expected = before;
    expected.set(row.flag, !before.shows(row.flag));
    key(row.key);
    EXPECT_EQ(user_->settings, expected) << row.label.english;
    key(row.key);
    EXPECT_EQ(user_->settings, before) << row.label.english;
  }
  for (int i = 0; i < kViewGroups; ++i) {
    ViewSettings expected = before;
    expected.geom_groups[static_cast<std::size_t>(i)] ^= true;
    key('0' + i);
    EXPECT_EQ(user_->settings, expected);
    key('0' + i);
    expected = before;
    expected.site_groups[static_cast<std::size_t>(i)] ^= true;
    key('0' + i, KeyModifier::shift);
    EXPECT_EQ(user_->settings, expected);
    key('0' + i, KeyModifier::shift);
  }
  key('0' + kViewGroups);
  key('B', KeyModifier::control);
  key('0', KeyModifier::control);
  EXPECT_EQ(user_->settings, before) << "keys that mean nothing";
  EXPECT_THAT(user_->take_events(), IsEmpty());
}

/// A tool in the scene that uses a press gets all until the release, with the line of sight.
TEST_F(UserTest, AHookThatUsesAPressGetsTheWholeDrag) {
  std::vector<MouseInput> seen;
  bool uses = true;
  user_->set_hook([&](const MouseInput& input) {
    seen.push_back(input);
    return uses;
  });
  const render::CameraView before = scene_.view();
  send(Kind::move, 100, 75);
  send(Kind::press, 100, 75, 0);
  send(Kind::move, 300, 225);
  send(Kind::release, 300, 225, 0);
  ASSERT_EQ(seen.size(), 4U);
  EXPECT_EQ(seen[1].kind, MouseInput::Kind::press);
  EXPECT_EQ(seen[3].kind, MouseInput::Kind::release);
  EXPECT_EQ(scene_.view().azimuth, before.azimuth) << "the camera does not see it";
  for (const MouseInput& input : seen) {
    const Ray ray = ray_of_pixel(eye_of(scene_), kViewWidth, kViewHeight, input.x * kViewWidth,
                                 (1 - input.y) * kViewHeight);
    EXPECT_LT((ray.origin_W - input.origin_W).norm(), 1e-12);
    EXPECT_LT((ray.direction_W - input.direction_W).norm(), 1e-12);
  }
  EXPECT_DOUBLE_EQ(seen[1].x, 0.25);
  EXPECT_DOUBLE_EQ(seen[2].y, 0.75);
  uses = false;
  seen.clear();
  drag(0, middle_, {30, 0});
  EXPECT_EQ(seen.size(), 1U) << "who does not use the press gets no more of that drag";
  EXPECT_NE(scene_.view().azimuth, before.azimuth);
}

}  // namespace
}  // namespace mjarm::view
