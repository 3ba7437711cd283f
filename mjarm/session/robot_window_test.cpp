#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <numbers>
#include <thread>

#include "mjarm/kinematics/fk.hpp"
#include "mjarm/session/robot_session_test.hpp"
#include "mjarm/session/simulate_world.hpp"
#include "mjarm/view/real_window_test.hpp"
#include "mjarm/view/target_handle.hpp"
#include "mjarm/view/window.hpp"

namespace mjarm::session {
namespace {

using ::testing::HasSubstr;

/// The same with a window that a stand-in for the user drives.
class RobotInWindow : public RobotInView {
 protected:
  static constexpr int kWidth = 640, kHeight = 480;

  void SetUp() override {
    if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "DISPLAY is not set";
    if (!std::filesystem::exists(testing::kXdotool)) GTEST_SKIP() << "xdotool is not installed";
    Result<view::Window> opened = view::Window::open(model_, kTitle,
                                                     {.width = kWidth,
                                                      .height = kHeight,
                                                      .quality = render::RenderQuality::low,
                                                      .can_target = true,
                                                      .jog_dofs = sim_.jog_dofs()});
    ASSERT_TRUE(opened) << opened.error().what;
    window_ = std::make_unique<view::Window>(std::move(*opened));
    handle_.attach(*window_);
    ASSERT_TRUE(frames_until([] { return id() != ""; })) << "the window does not appear";
    xdotool({"windowmove", "--sync", id(), "0", "0", "windowfocus", "--sync", id()});
    frames(5);
  }
  /// One round of the simulation and of the window, in one thread: nothing depends on the clock.
  void round() {
    for (const view::ViewEvent& event : window_->take_events()) view_.handle(event);
    (void)view_.take_drags();
    step(5);
    view_.fill(frame_);
    const Result<void> drawn =
        window_->draw(frame_.snapshot, frame_.overlay, frame_.plots, frame_.panels);
    ASSERT_TRUE(drawn) << drawn.error().what;
  }
  bool frames_until(const std::function<bool()>& holds, double seconds = 20) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end && !HasFatalFailure()) {
      round();
      if (holds()) return true;
    }
    return holds();
  }
  void frames(int count) {
    const long end = window_->stats().frames + count;
    frames_until([&] { return window_->stats().frames >= end; });
  }
  static void xdotool(const std::vector<std::string>& words) {
    const support::ProgramResult result = support::run_program(testing::kXdotool, words);
    EXPECT_EQ(result.exit_code, 0) << words[0] << ": " << result.err;
  }
  static std::string id() {
    const auto found = support::lines_of(
        support::run_program(testing::kXdotool, {"search", "--name", kTitle}).out);
    return found.empty() ? std::string() : found.back();
  }
  /// On a busy machine a click may get lost between the programs, and a user clicks again.
  bool act_until(const std::vector<std::string>& input, const std::function<bool()>& holds) {
    for (int attempt = 0; attempt < 4; ++attempt) {
      xdotool(input);
      if (frames_until(holds, 15)) return true;
    }
    return false;
  }
  [[nodiscard]] view::Eye eye() const {
    return view::eye_of(window_->view(), model_.raw()->vis.global.fovy * std::numbers::pi / 180);
  }
  [[nodiscard]] Eigen::Vector2d pixel(const Eigen::Vector3d& p_W) const {
    return view::pixel_of_point(eye(), kWidth, kHeight, p_W).value();
  }
  /// [m] of the handles' arrows.
  [[nodiscard]] double size() const {
    return view::GizmoOptions{}.size * eye().height_at(target_pose().p);
  }
  [[nodiscard]] Pose target_pose() const { return handle_.gizmo().pose(); }
  void press(const Eigen::Vector2d& at) {
    xdotool({"mousemove", word(at.x()), word(at.y()), "mousedown", "1"});
    frames(2);
  }
  void drag_to(const Eigen::Vector2d& at) {
    xdotool({"mousemove", word(at.x()), word(at.y())});
    frames(2);
  }
  void let_go() {
    xdotool({"mouseup", "1"});
    frames(2);
  }
  static std::string word(double pixels) { return std::to_string(std::lround(pixels)); }
  /// Takes the handle that is seen at a point.
  void take(view::GizmoHandle handle, const Eigen::Vector3d& p_W) {
    const auto is_held = [&] { return handle_.gizmo().held().has_value(); };
    for (int attempt = 0; attempt < 4 && !is_held(); ++attempt) {
      if (attempt > 0) let_go();
      press(pixel(p_W));
      frames_until(is_held, 15);
    }
    ASSERT_TRUE(is_held());
    ASSERT_EQ(*handle_.gizmo().held(), handle);
  }

  static constexpr const char* kTitle = "mjarm robot test";
  testing::Turn turn_;
  view::TargetHandle handle_{view_.target()->link(), true};
  std::unique_ptr<view::Window> window_;
};

TEST_F(RobotInWindow, AnArrowMovesTheToolAlongItsAxisOnly) {
  for (const int axis : {0, 2}) {
    const Pose before = target().pose();
    const render::CameraView camera = window_->view();
    const Eigen::Vector3d along = Eigen::Vector3d::Unit(axis);
    const Eigen::Vector3d held = before.p + 0.9 * size() * along;
    take(static_cast<view::GizmoHandle>(axis), held);
    drag_to(pixel(held - 0.1 * along));
    ASSERT_TRUE(frames_until([&] { return target().pose().p[axis] < before.p[axis] - 0.05; }));
    const Eigen::Vector3d way = target().pose().p - before.p;
    EXPECT_NEAR(way[axis], -0.1, 0.01);
    EXPECT_LT((way - way[axis] * along).norm(), 1e-9);
    EXPECT_LT(angle_between(target().pose().R, before.R), 1e-9);
    EXPECT_EQ(frame_.overlay.ghosts.size(), 1U);
    let_go();
    EXPECT_FALSE(handle_.gizmo().held());
    EXPECT_EQ(window_->view().azimuth, camera.azimuth) << "the camera turned";
    step(1500);
    expect_there(target().pose());
  }
}

TEST_F(RobotInWindow, ARingTurnsTheToolAboutItsAxisOnly) {
  const Pose before = target().pose();
  // On the ring about z, on the side of the camera, away from the arrows.
  const Eigen::Vector3d to_eye = eye().p_W - before.p;
  const double side = std::atan2(to_eye.y(), to_eye.x()) + 0.2;
  const double radius = 0.72 * size();
  const auto on_ring = [&](double angle) -> Eigen::Vector3d {
    return before.p + radius * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
  };
  take(view::GizmoHandle::turn_z, on_ring(side));
  drag_to(pixel(on_ring(side + 0.4)));
  ASSERT_TRUE(frames_until([&] { return angle_between(target().pose().R, before.R) > 0.2; }));
  let_go();
  const Eigen::Vector3d turn = rotation_log(target().pose().R * before.R.transpose());
  EXPECT_NEAR(turn.z(), 0.4, 0.05);
  EXPECT_LT(turn.head<2>().norm(), 1e-9);
  EXPECT_LT((target().pose().p - before.p).norm(), 1e-9);
  step(1500);
  expect_there(target().pose());
}

TEST_F(RobotInWindow, BeyondTheWorkspaceItIsRedAndSaysWhy) {
  const Pose before = target().pose();
  const Eigen::Vector3d held = before.p + 0.9 * size() * Eigen::Vector3d::UnitZ();
  take(view::GizmoHandle::move_z, held);
  drag_to({pixel(held).x(), 1});
  ASSERT_TRUE(frames_until([&] { return target().grade() == TargetGrade::unreachable; }));
  EXPECT_THAT(frame_.status, HasSubstr("out of reach"));
  EXPECT_EQ(handle_.look().color, color_of(TargetGrade::unreachable));
  const double reached = fk(arm_, as_span(sim_.goal())).p.z();
  EXPECT_GT(reached, before.p.z());
  EXPECT_LT(reached, target().pose().p.z());
  let_go();
  EXPECT_GT(target_pose().p.z(), reached);
  step(3000);
  EXPECT_NEAR(tool().p.z(), reached, 3e-3);
}

TEST_F(RobotInWindow, TheRestOfThePictureBelongsToTheCamera) {
  const render::CameraView before = window_->view();
  const Pose target_before = target().pose();
  press({60, 100});
  drag_to({160, 120});
  EXPECT_TRUE(frames_until([&] { return window_->view().azimuth != before.azimuth; }));
  let_go();
  EXPECT_EQ(target().pose().p, target_before.p);
}

TEST_F(RobotInWindow, KeyAndPanelAreConnected) {
  ASSERT_TRUE(act_until({"key", "shift+Tab"},
                        [&] { return window_->item_spot(false, 0, -1).has_value(); }));
  const auto click_until = [&](const std::string& title, const std::string& name,
                               const std::function<bool()>& holds) {
    const Place item = place(title, name);
    // The joints' section comes first.
    const auto spot = window_->item_spot(false, item.section + 1, item.index);
    if (!spot) return false;
    return act_until({"mousemove", word(spot->x), word(spot->y), "click", "1"}, holds);
  };
  EXPECT_TRUE(click_until("Target", "Target", [&] { return !handle_.look().shown; }));
  EXPECT_TRUE(frame_.status.empty());
  EXPECT_TRUE(
      act_until({"windowfocus", id(), "key", "ctrl+t"}, [&] { return handle_.look().shown; }));
  EXPECT_TRUE(click_until("Target", "Follow", [&] {
    return !std::get<view::PanelCheckbox>(place("Target", "Follow").item->what).on;
  }));
}

/// As the command runs it: the simulation in a thread of its own.
TEST_F(RobotInWindow, InItsOwnThreadTheArmFollowsAsWell) {
  const Pose before = target_pose();
  const Eigen::Vector3d held = before.p + 0.9 * size() * Eigen::Vector3d::UnitX();
  const Eigen::Vector2d from = pixel(held);
  const Eigen::Vector2d to = pixel(held - 0.1 * Eigen::Vector3d::UnitX());
  // Each thing the user does waits for what the one before did, not for the clock: pictures may be
  // slow.
  enum class Hand { away, pressed, dragging, let_go };
  Hand hand = Hand::away;
  int waited = 0;
  const auto act = [&] {
    const bool is_held = handle_.gizmo().held().has_value();
    if (hand == Hand::away || (hand == Hand::pressed && !is_held && ++waited > 20)) {
      xdotool({"mouseup", "1", "mousemove", word(from.x()), word(from.y()), "mousedown", "1"});
      hand = Hand::pressed;
      waited = 0;
    } else if (hand == Hand::pressed && is_held) {
      xdotool({"mousemove", word(to.x()), word(to.y())});
      hand = Hand::dragging;
    } else if (hand == Hand::dragging && target_pose().p.x() < before.p.x() - 0.05) {
      xdotool({"mouseup", "1"});
      hand = Hand::let_go;
    }
    return hand == Hand::let_go && !is_held;
  };
  view::ViewLink link;
  std::thread worker([&] { simulate_world(view_, link); });
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  bool moved = false;
  const Result<void> drawn = view::draw_until_closed(*window_, link, [&] {
    moved = act();
    return moved || std::chrono::steady_clock::now() > end;
  });
  worker.join();
  (void)view_.take_drags();  // what came at the very end
  ASSERT_TRUE(drawn);
  ASSERT_TRUE(moved);
  EXPECT_NEAR(target().pose().p.x(), before.p.x() - 0.1, 0.01);
  EXPECT_LT((target().pose().p - before.p).tail<2>().norm(), 1e-9);
  step(1500);
  expect_there(target().pose());
}

}  // namespace
}  // namespace mjarm::session
