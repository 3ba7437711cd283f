#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "mjarm/view/turn_test.hpp"
#include "mjarm/view/window.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::testing {

inline constexpr const char* kXdotool = "/usr/bin/xdotool";
inline constexpr const char* kWindowTitle = "mjarm window test";

/// A red ball on two slides, on a floor below the picture.
inline Model window_scene() {
  const support::TempFolder folder;
  return Model::load(folder.write("scene.xml", R"(
<mujoco>
  <visual><headlight ambient="1 1 1" diffuse="0 0 0" specular="0 0 0"/></visual>
  <statistic center="0 0 0" extent="2"/>
  <worldbody>
    <camera name="front" pos="0 -3 0" xyaxes="1 0 0 0 0 1"/>
    <camera name="side" pos="3 0 0" xyaxes="0 1 0 0 0 1"/>
    <geom name="floor" type="plane" size="0.5 0.5 0.1" pos="0 0 -3" rgba="0 1 0 1"/>
    <body name="ball">
      <joint name="x" type="slide" axis="1 0 0" range="-0.5 1.5"/>
      <joint name="z" type="slide" axis="0 0 1"/>
      <geom name="skin" type="sphere" size="0.4" rgba="1 0 0 1"/>
    </body>
  </worldbody>
</mujoco>)"))
      .value();
}

/// A window that a stand-in for the user drives.
class RealWindow : public ::testing::Test {
 protected:
  virtual view::WindowOptions options() {
    return {.width = 400, .height = 300, .camera = {.name = "front"}};
  }
  void SetUp() override {
    if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "DISPLAY is not set";
    if (!std::filesystem::exists(kXdotool)) GTEST_SKIP() << "xdotool is not installed";
    Result<view::Window> opened = view::Window::open(model_, kWindowTitle, options());
    ASSERT_TRUE(opened) << opened.error().what;
    window_ = std::make_unique<view::Window>(std::move(*opened));
    ASSERT_TRUE(frames_until([this] { return id() != ""; })) << "the window does not appear";
    xdotool({"windowmove", "--sync", id(), "0", "0", "windowfocus", "--sync", id()});
    frames_until([] { return false; }, 0.2);
  }

  /// Draws until something holds, at most so many seconds; returns whether it came to hold.
  bool frames_until(const std::function<bool()>& holds, double seconds = 20) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end) {
      const Result<void> drawn = window_->draw({}, {}, {}, panels_);
      if (!drawn) ADD_FAILURE() << drawn.error().what;
      for (view::ViewEvent& event : window_->take_events()) events_.push_back(std::move(event));
      if (holds()) return true;
    }
    return holds();
  }
  /// Lets the stand-in do something until it shows: on a busy machine a click may get lost between
  /// the programs, and a user clicks again.
  bool act_until(const std::vector<std::string>& input, const std::function<bool()>& holds) {
    for (int attempt = 0; attempt < 4; ++attempt) {
      xdotool(input);
      if (frames_until(holds, 5)) return true;
    }
    return false;
  }
  /// The latest event of a kind; null where there was none.
  template <class Event>
  [[nodiscard]] const Event* last() const {
    for (auto event = events_.rbegin(); event != events_.rend(); ++event) {
      if (const auto* found = std::get_if<Event>(&*event)) return found;
    }
    return nullptr;
  }
  /// Lets the stand-in do something until it gives an event of that kind.
  template <class Event>
  const Event* act_for(const std::vector<std::string>& input) {
    events_.clear();
    return act_until(input, [this] { return last<Event>() != nullptr; }) ? last<Event>() : nullptr;
  }
  static support::ProgramResult xdotool(const std::vector<std::string>& arguments) {
    support::ProgramResult result = support::run_program(kXdotool, arguments);
    if (result.exit_code != 0) std::cerr << "xdotool " << arguments[0] << ": " << result.err;
    return result;
  }
  static std::string id() {
    const auto found = support::lines_of(xdotool({"search", "--name", kWindowTitle}).out);
    return found.empty() ? std::string() : found.back();
  }
  static std::vector<std::string> drag(const std::string& button, int dx, int dy) {
    return {"mousemove",
            "200",
            "150",
            "mousedown",
            button,
            "mousemove_relative",
            "--",
            std::to_string(dx),
            std::to_string(dy),
            "mouseup",
            button};
  }

  Turn turn_;
  std::vector<view::ViewEvent> events_;
  std::vector<view::PanelSection> panels_;
  Model model_ = window_scene();
  std::unique_ptr<view::Window> window_;
};

}  // namespace mjarm::testing
