#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <filesystem>

#include "mjarm/view/controls.hpp"
#include "mjarm/view/real_window_test.hpp"

namespace mjarm::view {
namespace {

/// A window that a stand-in for the user drives, with everything allowed.
class Controls : public testing::RealWindow {
 protected:
  WindowOptions options() override {
    WindowOptions options = RealWindow::options();
    options.jog_dofs = {0};
    options.can_target = true;
    options.screenshots = folder_.path() / "shots";
    return options;
  }
  void press(const std::string& key) { xdotool({"key", key}); }
  [[nodiscard]] bool key_until(const std::string& key, const std::function<bool()>& holds) {
    return act_until({"key", key}, holds);
  }

  support::TempFolder folder_;
};

TEST_F(Controls, EveryKeyOfASettingTogglesIt) {
  for (const SettingRow& row : setting_rows()) {
    std::string key(1, static_cast<char>(std::tolower(row.key)));
    if (key == "/") key = "slash";
    ViewSettings expected = window_->settings();
    expected.set(row.flag, !expected.shows(row.flag));
    EXPECT_TRUE(key_until(key, [&] { return window_->settings() == expected; }))
        << row.label.english;
  }
}

TEST_F(Controls, DigitsToggleGroups) {
  for (int i = 0; i < kViewGroups; ++i) {
    ViewSettings expected = window_->settings();
    bool& geoms = expected.geom_groups[static_cast<std::size_t>(i)];
    geoms = !geoms;
    EXPECT_TRUE(key_until(std::to_string(i), [&] { return window_->settings() == expected; })) << i;
  }
  ViewSettings expected = window_->settings();
  expected.site_groups[4] = true;
  EXPECT_TRUE(key_until("shift+4", [&] { return window_->settings() == expected; }));
}

TEST_F(Controls, GroupsAndFlagsReachThePicture) {
  const auto middle = [this] {
    const render::Image image = window_->picture().value();
    return image.pixel(image.width / 2, image.height / 2)[0];
  };
  EXPECT_GT(middle(), 150);
  EXPECT_TRUE(key_until("0", [&] { return middle() < 100; }));
  EXPECT_TRUE(key_until("0", [&] { return middle() > 150; }));
}

TEST_F(Controls, FramesAndLabelsGoRound) {
  EXPECT_TRUE(key_until("F6", [&] { return window_->settings().frame == 1; }));
  EXPECT_TRUE(key_until("F7", [&] { return window_->settings().label == 1; }));
}

TEST_F(Controls, SpaceAndArrowsPauseAndStep) {
  ASSERT_NE(act_for<PauseEvent>({"key", "space"}), nullptr);
  EXPECT_TRUE(last<PauseEvent>()->paused);
  ASSERT_NE(act_for<PauseEvent>({"key", "space"}), nullptr);
  EXPECT_FALSE(last<PauseEvent>()->paused);
  // A step pauses first.
  ASSERT_NE(act_for<StepEvent>({"key", "Right"}), nullptr);
  EXPECT_EQ(last<StepEvent>()->steps, 1);
  ASSERT_NE(last<PauseEvent>(), nullptr);
  EXPECT_TRUE(std::holds_alternative<PauseEvent>(events_.front()));
  EXPECT_TRUE(window_->paused());
  ASSERT_NE(act_for<StepEvent>({"key", "Left"}), nullptr);
  EXPECT_EQ(last<StepEvent>()->steps, -1);
}

TEST_F(Controls, PlusAndMinusChangeTheSpeed) {
  ASSERT_NE(act_for<SpeedEvent>({"key", "plus"}), nullptr);
  EXPECT_EQ(last<SpeedEvent>()->speed, 2);
  ASSERT_NE(act_for<SpeedEvent>({"key", "minus"}), nullptr);
  EXPECT_EQ(last<SpeedEvent>()->speed, 1);
  ASSERT_NE(act_for<SpeedEvent>({"key", "minus"}), nullptr);
  EXPECT_EQ(last<SpeedEvent>()->speed, 0.5);
}

TEST_F(Controls, BackspaceResets) { EXPECT_NE(act_for<ResetEvent>({"key", "BackSpace"}), nullptr); }

TEST_F(Controls, CtrlTAsksForTheTarget) {
  EXPECT_NE(act_for<TargetEvent>({"key", "ctrl+t"}), nullptr);
  EXPECT_FALSE(window_->settings().shows(ViewFlag::transparent)) << "T alone is another key";
}

/// The eye is the one of this frame, after the mouse has moved the camera.
TEST_F(Controls, TheDrawHookSeesTheEyeAndAddsToThePicture) {
  const auto middle = [this] {
    const render::Image image = window_->picture().value();
    return image.pixel(image.width / 2, image.height / 2)[2];
  };
  frames_until([] { return false; }, 0.1);
  EXPECT_LT(middle(), 100);
  Eye seen;
  window_->set_draw_hook([&seen](const Eye& eye, render::Overlay& overlay) {
    seen = eye;
    overlay.spheres.push_back({eye.p_W + eye.forward_W, 0.1, {0, 0, 1, 1}});
  });
  EXPECT_TRUE(frames_until([&] { return middle() > 200; }));
  ASSERT_TRUE(act_until(drag("1", 50, 0), [&] { return window_->view().azimuth < 1.5; }));
  const Eye now = eye_of(window_->view(), 0.5);
  EXPECT_LT((seen.p_W - now.p_W).norm(), 1e-5);
  EXPECT_LT((seen.forward_W - now.forward_W).norm(), 1e-5);
}

TEST_F(Controls, BracketsGoThroughTheCameras) {
  EXPECT_TRUE(key_until("bracketright", [&] { return window_->camera_name() == "front"; }));
  EXPECT_TRUE(key_until("bracketright", [&] { return window_->camera_name() == "side"; }));
  EXPECT_NEAR(std::abs(window_->view().azimuth), 3.14159, 1e-3);
  EXPECT_TRUE(key_until("bracketleft", [&] { return window_->camera_name() == "front"; }));
  EXPECT_TRUE(key_until("ctrl+a", [&] { return window_->camera_name().empty(); }));
}

TEST_F(Controls, TabAndRightClickShowThePanels) {
  const auto left = [this] { return window_->item_spot(true, 0, -1).has_value(); };
  const auto right = [this] { return window_->item_spot(false, 0, -1).has_value(); };
  EXPECT_FALSE(left() || right());
  EXPECT_TRUE(key_until("Tab", left));
  EXPECT_TRUE(key_until("Tab", [&] { return !left(); }));
  EXPECT_TRUE(key_until("shift+Tab", right));
  EXPECT_FALSE(left());
  EXPECT_TRUE(key_until("shift+Tab", [&] { return !right(); }));
  const render::CameraView before = window_->view();
  EXPECT_TRUE(act_until({"mousemove", "350", "150", "click", "3"}, left));
  EXPECT_TRUE(act_until({"mousemove", "350", "150", "click", "3"}, [&] { return !left(); }));
  EXPECT_EQ(window_->view().lookat_W, before.lookat_W);
  // A drag with the right button pans, and shows no panel.
  ASSERT_TRUE(
      act_until(drag("3", 60, 0), [&] { return window_->view().lookat_W != before.lookat_W; }));
  frames_until([] { return false; }, 0.1);
  EXPECT_FALSE(left());
}

TEST_F(Controls, HelpCoversThePicture) {
  const std::vector<std::uint8_t> plain = window_->picture()->rgb;
  EXPECT_TRUE(key_until("F1", [&] {
    const render::Image image = window_->picture().value();
    return image.pixel(image.width / 2, image.height / 2 + 20)[0] < 150;
  }));
}

TEST_F(Controls, ScreenshotsAreWrittenWhereTheApplicationSays) {
  const auto* shot = act_for<ScreenshotEvent>({"key", "ctrl+p"});
  ASSERT_NE(shot, nullptr);
  EXPECT_EQ(shot->error, "");
  EXPECT_EQ(shot->file, (folder_.path() / "shots" / "mjarm-001.png").string());
  EXPECT_GT(std::filesystem::file_size(shot->file), 500U);
}

TEST_F(Controls, DoubleClickSelects) {
  const std::vector<std::string> twice = {"mousemove", "200",     "150", "click", "--repeat",
                                          "2",         "--delay", "30",  "1"};
  const auto* selected = act_for<SelectEvent>(twice);
  ASSERT_NE(selected, nullptr);
  EXPECT_EQ(selected->body_name, "ball");
  EXPECT_EQ(selected->geom_name, "skin");
  EXPECT_NEAR(selected->point_W.y(), -0.4, 0.01);
}

TEST_F(Controls, ControlDragPushesUntilTheButtonIsReleased) {
  for (const std::string button : {"3", "1"}) {
    const render::CameraView before = window_->view();
    const auto pushes = [this] {
      const auto* push = last<PushEvent>();
      return push != nullptr && push->force_W.norm() + push->torque_W.norm() > 1e-3;
    };
    events_.clear();
    xdotool({"keydown", "ctrl", "mousemove", "200", "150", "mousedown", button});
    EXPECT_TRUE(act_until({"mousemove_relative", "40", "0"}, pushes)) << button;
    xdotool({"mouseup", button, "keyup", "ctrl"});
    ASSERT_TRUE(frames_until([this] { return last<ReleaseEvent>() != nullptr; }));
    const auto* push = last<PushEvent>();
    ASSERT_NE(push, nullptr);
    EXPECT_EQ(push->name, "ball");
    if (button == "3") {
      EXPECT_GT(push->force_W.x(), 1);
    } else {
      EXPECT_GT(push->torque_W.norm(), 1e-3);
    }
    EXPECT_TRUE(std::holds_alternative<ReleaseEvent>(events_.back()));
    EXPECT_EQ(window_->view().lookat_W, before.lookat_W);
    EXPECT_EQ(window_->view().azimuth, before.azimuth);
  }
}

TEST_F(Controls, AToolInTheSceneTakesTheMouseFirst) {
  std::vector<MouseInput> seen;
  window_->set_mouse_hook([&seen](const MouseInput& input) {
    seen.push_back(input);
    return input.x < 0.6;
  });
  const render::CameraView before = window_->view();
  ASSERT_TRUE(act_until(drag("1", 60, 30), [&] {
    return !seen.empty() && seen.back().kind == MouseInput::Kind::release;
  }));
  EXPECT_EQ(window_->view().azimuth, before.azimuth);
  const auto pressed = std::find_if(seen.begin(), seen.end(), [](const MouseInput& input) {
    return input.kind == MouseInput::Kind::press;
  });
  ASSERT_NE(pressed, seen.end());
  EXPECT_NEAR(pressed->x, 0.5, 0.01);
  EXPECT_NEAR((pressed->origin_W - Eigen::Vector3d(0, -3, 0)).norm(), 0, 1e-3);
  EXPECT_NEAR(pressed->direction_W.y(), 1, 1e-3);
}

TEST_F(Controls, ResizingAndHidingAreSurvived) {
  for (const auto& [width, height] : {std::pair{640, 480}, {1, 1}, {300, 200}}) {
    EXPECT_TRUE(
        act_until({"windowsize", "--sync", id(), std::to_string(width), std::to_string(height)},
                  [&] {
                    const Result<render::Image> image = window_->picture();
                    return image && image->width == width && image->height == height;
                  }))
        << width;
  }
  const std::string window = id();
  xdotool({"windowunmap", window});
  frames_until([] { return false; }, 0.2);
  xdotool({"windowminimize", window});
  frames_until([] { return false; }, 0.2);
  xdotool({"windowmap", window, "windowfocus", window});
  EXPECT_TRUE(key_until("space", [&] { return window_->paused(); }));
}

/// A larger window, with panels.
class PanelItems : public Controls {
 protected:
  WindowOptions options() override {
    WindowOptions options = Controls::options();
    options.width = 900;
    options.height = 760;
    return options;
  }
  /// Presses an item at a share of its width.
  [[nodiscard]] std::vector<std::string> click(bool left, int section, int item) const {
    const auto spot = window_->item_spot(left, section, item);
    EXPECT_TRUE(spot) << section << " " << item;
    if (!spot) return {};
    return {"mousemove", std::to_string(static_cast<int>(spot->x)),
            std::to_string(static_cast<int>(spot->y)), "click", "1"};
  }
};

TEST_F(PanelItems, OfTheSettingsActLikeTheirKeys) {
  ASSERT_TRUE(key_until("Tab", [&] { return window_->item_spot(true, 0, -1).has_value(); }));
  ASSERT_NE(act_for<PauseEvent>(click(true, 0, 0)), nullptr);
  EXPECT_TRUE(window_->paused());
  ASSERT_NE(act_for<StepEvent>(click(true, 0, 2)), nullptr);
  EXPECT_EQ(last<StepEvent>()->steps, -1);
  ASSERT_NE(act_for<StepEvent>(click(true, 0, 3)), nullptr);
  EXPECT_EQ(last<StepEvent>()->steps, 1);
  ASSERT_NE(act_for<SpeedEvent>(click(true, 0, 4)), nullptr);
  EXPECT_EQ(last<SpeedEvent>()->speed, 0.5);
  ASSERT_NE(act_for<SpeedEvent>(click(true, 0, 5)), nullptr);
  EXPECT_EQ(last<SpeedEvent>()->speed, 1);
  EXPECT_NE(act_for<ResetEvent>(click(true, 0, 6)), nullptr);
  EXPECT_NE(act_for<ScreenshotEvent>(click(true, 0, 8)), nullptr);
  // The first two items of the settings are menus; contact points and forces come next.
  for (const int flag : {0, 1, 4}) {
    ViewSettings expected = window_->settings();
    expected.flags[static_cast<std::size_t>(flag)] = true;
    EXPECT_TRUE(act_until(click(true, 1, 2 + flag), [&] {
      return window_->settings() == expected;
    })) << flag;
  }
  std::vector<std::string> menu = click(true, 1, 1);
  menu.resize(3);
  menu.insert(menu.end(), {"mousedown", "1", "sleep", "0.1", "mousemove_relative", "0", "54",
                           "sleep", "0.1", "mouseup", "1"});
  EXPECT_TRUE(act_until(menu, [&] { return window_->settings().frame != 0; }));
}

TEST_F(PanelItems, FoldAway) {
  ASSERT_TRUE(key_until("Tab", [&] { return window_->item_spot(true, 0, 2).has_value(); }));
  EXPECT_TRUE(
      act_until(click(true, 0, -1), [&] { return !window_->item_spot(true, 0, 2).has_value(); }));
}

TEST_F(PanelItems, JointSlidersJogWhereTheApplicationTakesIt) {
  ASSERT_TRUE(key_until("shift+Tab", [&] { return window_->item_spot(false, 0, 1).has_value(); }));
  const auto* jogged = act_for<JointEvent>(click(false, 0, 1));
  ASSERT_NE(jogged, nullptr);
  EXPECT_EQ(jogged->dof, 0);
  EXPECT_EQ(jogged->joint, "x");
  EXPECT_NEAR(jogged->value, 0.5, 0.02);  // the middle of -0.5 to 1.5
  // The other joint is nobody's to move.
  events_.clear();
  xdotool(click(false, 0, 3));
  frames_until([] { return false; }, 0.2);
  EXPECT_EQ(last<JointEvent>(), nullptr);
}

TEST_F(PanelItems, OfTheApplicationComeBackAsEvents) {
  panels_ = {{"Program",
              {{10, "Run", PanelButton{}},
               {11, "Loop", PanelCheckbox{false}},
               {12, "Speed", PanelSlider{0.2, 0, 1}},
               {13, "State", PanelText{"ready"}},
               {14, "Frame", PanelChoice{{"world", "tool"}, 0}},
               {15, "", PanelList{{"movej", "movel", "wait", "grip"}, 0}},
               {16, "", PanelTimeline{0, 8}},
               {17, "Off", PanelButton{}, false}}}};
  ASSERT_TRUE(key_until("shift+Tab", [&] { return window_->item_spot(false, 1, 0).has_value(); }));
  const auto expect = [this](int item, int event, double value, double tolerance) {
    const auto* used = act_for<PanelEvent>(click(false, 1, item));
    ASSERT_NE(used, nullptr) << item;
    EXPECT_EQ(used->id, event);
    EXPECT_NEAR(used->value, value, tolerance) << item;
  };
  expect(0, 10, 1, 0);
  expect(1, 11, 1, 0);
  expect(2, 12, 0.5, 0.02);
  expect(5, 15, 2, 0);  // the middle of four lines, from above
  expect(6, 16, 4, 0.1);
  events_.clear();
  xdotool(click(false, 1, 7));
  frames_until([] { return false; }, 0.2);
  EXPECT_EQ(last<PanelEvent>(), nullptr);
}

/// What the application says is drawn; a list of another length builds the panel anew.
TEST_F(PanelItems, ShowWhatTheApplicationSays) {
  panels_ = {{"State", {{1, "Phase", PanelText{"ready"}}, {2, "", PanelList{{"a", "b"}, 0}}}}};
  ASSERT_TRUE(key_until("shift+Tab", [&] { return window_->item_spot(false, 1, 0).has_value(); }));
  frames_until([] { return false; }, 0.3);
  const std::vector<std::uint8_t> ready = window_->picture()->rgb;
  panels_[0].items[0].what = PanelText{"running"};
  EXPECT_TRUE(frames_until([&] { return window_->picture()->rgb != ready; }));
  const double before = window_->item_spot(false, 1, 1)->y;
  panels_[0].items[1].what = PanelList{std::vector<std::string>(50, "movel"), 40};
  EXPECT_TRUE(frames_until([&] { return window_->item_spot(false, 1, 1)->y > before + 100; }));
}

/// An application whose own sections matter most.
class PanelAtFirst : public PanelItems {
 protected:
  WindowOptions options() override {
    WindowOptions options = PanelItems::options();
    options.right_panel = true;
    options.joints_open = false;
    return options;
  }
};

TEST_F(PanelAtFirst, IsThereWithItsJointsFoldedAway) {
  ASSERT_TRUE(window_->item_spot(false, 0, -1).has_value());
  EXPECT_FALSE(window_->item_spot(false, 0, 0).has_value());
  EXPECT_TRUE(
      act_until(click(false, 0, -1), [&] { return window_->item_spot(false, 0, 0).has_value(); }));
}

/// An application that cannot do something says so, and gets no events of it.
class Refusals : public Controls {
 protected:
  WindowOptions options() override {
    WindowOptions options = RealWindow::options();
    options.can_step = options.can_reset = options.can_push = false;
    return options;
  }
};

TEST_F(Refusals, GiveNoEvents) {
  for (const char* key : {"Right", "BackSpace", "ctrl+p"}) press(key);
  xdotool({"keydown", "ctrl"});
  xdotool(drag("3", 30, 0));
  xdotool({"keyup", "ctrl"});
  ASSERT_TRUE(key_until("space", [&] { return window_->paused(); }));
  ASSERT_EQ(events_.size(), 1U);
  EXPECT_NE(last<PauseEvent>(), nullptr);
}

}  // namespace
}  // namespace mjarm::view
