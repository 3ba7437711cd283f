#include "apps/mjarm/view_robot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <numbers>
#include <thread>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/view/real_window_test.hpp"

namespace mjarm::app {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A robot in `mjarm view`, without its window.
class RobotInView : public ::testing::Test {
 protected:
  void step(int steps) {
    for (int i = 0; i < steps; ++i) view_.step();
  }
  const ViewFrame& frame() {
    view_.fill(frame_);
    return frame_;
  }
  /// The item with this name; its section and place in the panel as well.
  struct Place {
    const PanelItem* item = nullptr;
    int section = -1;
    int index = -1;
  };
  Place place(const std::string& title, const std::string& name) {
    const std::vector<PanelSection>& panels = frame().panels;
    for (std::size_t i = 0; i < panels.size(); ++i) {
      if (panels[i].title != title) continue;
      for (std::size_t k = 0; k < panels[i].items.size(); ++k) {
        const PanelItem& item = panels[i].items[k];
        if (item.name == name) return {&item, static_cast<int>(i), static_cast<int>(k)};
      }
    }
    ADD_FAILURE() << title << ": " << name;
    std::abort();
  }
  void use(const std::string& title, const std::string& name, double value = 1) {
    view_.handle(PanelEvent{place(title, name).item->id, value});
  }
  std::string shown(const std::string& title, const std::string& name) {
    return std::get<PanelText>(place(title, name).item->what).value;
  }
  [[nodiscard]] const ToolTarget& target() { return view_.target()->target(); }
  [[nodiscard]] Pose tool() const { return sim_.sim().tool(arm_); }
  void expect_there(const Pose& X_WT) const {
    EXPECT_LT((tool().p - X_WT.p).norm(), 2e-3);
    EXPECT_LT(angle_between(tool().R, X_WT.R), 5e-3);
  }
  void drag(const Pose& X_WT, bool held) {
    view_.target()->link().drags.push({{X_WT, held, ++drags_}});
    EXPECT_TRUE(view_.take_drags());
    EXPECT_FALSE(view_.take_drags());
  }

  Model model_ = Model::load(find_model_file("ur5e").value()).value();
  Arm arm_ = find_arm(model_).value();
  ViewSim sim_ = ViewSim::make(model_, arm_, false).value();
  RobotView view_{model_, arm_, sim_};
  ViewFrame frame_;
  long drags_ = 0;
};

TEST_F(RobotInView, ButtonsMoveTheArm) {
  const Pose before = target().pose();
  use("Tool", "Move by", 2);
  use("Tool", "+ x");
  use("Tool", "- z");
  use("Tool", "Frame", 1);
  use("Tool", "Turn by", 2);
  use("Tool", "+ rz");
  Pose expected = before;
  expected.p += Eigen::Vector3d(0.05, 0, -0.05);
  expected.R = before.R * rotation_exp({0, 0, std::numbers::pi / 12});
  EXPECT_LT((target().pose().p - expected.p).norm(), 1e-9);
  EXPECT_LT(angle_between(target().pose().R, expected.R), 1e-9);
  step(1500);
  expect_there(expected);
  EXPECT_EQ(shown("Target", "State"), "reachable");
  EXPECT_THAT(shown("Tool", "z [mm], rz [deg]"), StartsWith("438."));
}

TEST_F(RobotInView, WithoutFollowTheArmWaitsForGo) {
  use("Target", "Follow", 0);
  const JointVec before = sim_.goal();
  use("Tool", "Move by", 2);
  use("Tool", "+ x");
  EXPECT_EQ(sim_.goal(), before);
  ASSERT_EQ(frame().overlay.ghosts.size(), 1U);
  const std::vector<double>& ghost = frame().overlay.ghosts[0].qpos;
  EXPECT_TRUE(std::equal(ghost.begin(), ghost.end(), target().goal().begin()));
  step(300);
  EXPECT_EQ(sim_.goal(), before);
  use("Target", "Go");
  EXPECT_EQ(sim_.goal(), target().goal());
  EXPECT_TRUE(frame().overlay.ghosts.empty());
  step(1500);
  expect_there(target().pose());
  // The other way: the target comes back to the arm.
  use("Tool", "+ x");
  EXPECT_NE(sim_.goal(), target().goal());
  use("Target", "Back to arm");
  EXPECT_EQ(sim_.goal(), target().goal());
}

TEST_F(RobotInView, DragsLeadTheArmAndShowItsGhost) {
  Pose X_WT = target().pose();
  X_WT.p.x() += 0.1;
  drag(X_WT, true);
  EXPECT_EQ(frame().overlay.ghosts.size(), 1U);
  EXPECT_GT(frame().overlay.ghosts[0].color.g, 0.7F);
  drag(X_WT, false);
  EXPECT_TRUE(frame().overlay.ghosts.empty());
  step(1500);
  expect_there(X_WT);
  // Out of the workspace the arm stays at the edge, and the line says why.
  Pose X_far = X_WT;
  X_far.p.x() += 3;
  drag(X_far, true);
  const ViewFrame& red = frame();
  EXPECT_THAT(red.status, HasSubstr("not reachable: out of reach"));
  ASSERT_EQ(red.overlay.ghosts.size(), 1U);
  EXPECT_GT(red.overlay.ghosts[0].color.r, 0.8F);
  TargetLook look;
  ASSERT_TRUE(view_.target()->link().looks.take(look));
  EXPECT_EQ(look.X_WT.p, X_far.p);
  EXPECT_EQ(look.number, drags_);
  EXPECT_EQ(look.color, color_of(TargetGrade::unreachable));
  drag(X_far, false);
  step(4000);
  expect_there(fk(arm_, view(sim_.goal())));
  EXPECT_LT(tool().p.x(), 1);
  EXPECT_EQ(shown("Target", "State"), "not reachable");
}

TEST_F(RobotInView, SlidersResetsAndStepsBackTakeTheTargetAlong) {
  view_.handle(JointEvent{arm_.joints[0].dof, "pan", 0.3});
  EXPECT_EQ(target().goal()[0], 0.3);
  EXPECT_LT((target().pose().p - fk(arm_, view(sim_.goal())).p).norm(), 1e-12);
  step(20);
  use("Tool", "+ x");
  const JointVec after = target().goal();
  step(5);
  for (int i = 0; i < 10; ++i) view_.handle(StepEvent{-1});
  EXPECT_NE(target().goal(), after);
  EXPECT_EQ(target().goal()[0], 0.3);
  view_.handle(ResetEvent{});
  EXPECT_EQ(target().goal(), arm_.home);
}

TEST_F(RobotInView, TheKeyPutsTheTargetAway) {
  const auto look = [this] {
    view_.fill(frame_);
    TargetLook taken;
    EXPECT_TRUE(view_.target()->link().looks.take(taken));
    return taken;
  };
  EXPECT_TRUE(look().shown);
  EXPECT_FALSE(frame_.status.empty());
  view_.handle(TargetEvent{});
  EXPECT_FALSE(look().shown);
  EXPECT_TRUE(frame_.status.empty());
  use("Target", "Target", 1);
  EXPECT_TRUE(look().shown);
}

TEST_F(RobotInView, CheckBoxesChangeTheOverlay) {
  step(50);
  EXPECT_TRUE(frame().overlay.ellipsoids.empty());
  use("Show", "Ellipsoid");
  ASSERT_EQ(frame().overlay.ellipsoids.size(), 1U);
  EXPECT_LT((frame().overlay.ellipsoids[0].X_WE.p - tool().p).norm(), 1e-9);
  use("Show", "Ellipsoid", 0);
  EXPECT_TRUE(frame().overlay.ellipsoids.empty());

  use("Show", "Ghost of goal");
  EXPECT_EQ(frame().overlay.ghosts.size(), 1U);

  EXPECT_TRUE(frame().overlay.labels.empty());
  use("Show", "Closest pair");
  ASSERT_EQ(frame().overlay.labels.size(), 1U);
  EXPECT_THAT(frame().overlay.labels[0].text, HasSubstr(" mm"));
  use("Show", "Closest pair", 0);

  EXPECT_TRUE(frame().overlay.spheres.empty());
  use("Show", "Contacts");
  EXPECT_TRUE(frame().overlay.spheres.empty());
  // The elbow folded until the arm touches itself.
  view_.handle(JointEvent{arm_.joints[2].dof, "elbow", 3.1});
  step(3000);
  EXPECT_FALSE(frame().overlay.spheres.empty());
  use("Show", "Contacts", 0);
  EXPECT_TRUE(frame().overlay.spheres.empty());
}

TEST_F(RobotInView, TheTrailIsALineOrBallsOrOff) {
  view_.handle(JointEvent{arm_.joints[0].dof, "pan", 0.5});
  step(1000);
  ASSERT_EQ(frame().overlay.lines.size(), 1U);
  EXPECT_GT(frame().overlay.lines[0].points_W.size(), 20U);
  EXPECT_LT((frame().overlay.lines[0].points_W.back() - tool().p).norm(), 5e-3);
  use("Show", "Trail", 2);
  EXPECT_TRUE(frame().overlay.lines.empty());
  EXPECT_GT(frame().overlay.spheres.size(), 5U);
  use("Show", "Trail", 0);
  EXPECT_TRUE(frame().overlay.spheres.empty());
}

TEST_F(RobotInView, FiguresAreShownAsAskedFor) {
  step(200);
  EXPECT_TRUE(frame().plots.empty());
  use("Plots", "Joints");
  use("Plots", "Manipulability");
  ASSERT_EQ(frame().plots.size(), 2U);
  EXPECT_THAT(frame().plots[0].title, StartsWith("joints"));
  EXPECT_THAT(frame().plots[1].title, StartsWith("manipulability"));
  EXPECT_GT(frame().plots[1].series.at(0).x.size(), 5U);
  use("Plots", "Joints", 0);
  EXPECT_EQ(frame().plots.size(), 1U);
}

TEST(RobotView, WithoutAHeldArmThereIsNoTarget) {
  const Model model = Model::load(find_model_file("ur5e").value()).value();
  const Arm arm = find_arm(model).value();
  ViewSim passive = ViewSim::make(model, arm, true).value();
  RobotView view(model, arm, passive);
  EXPECT_EQ(view.target(), nullptr);
  for (int i = 0; i < 20; ++i) view.step();
  ViewFrame frame;
  view.fill(frame);
  EXPECT_EQ(frame.panels.size(), 2U);
  EXPECT_TRUE(frame.status.empty());

  const Model car = Model::load(find_model_file("car").value()).value();
  ViewSim driving = ViewSim::make(car, std::nullopt, false).value();
  RobotView bare(car, std::nullopt, driving);
  bare.step();
  bare.handle(PanelEvent{1000, 1});
  bare.handle(TargetEvent{});
  bare.fill(frame);
  EXPECT_TRUE(frame.panels.empty());
}

/// The same with a window that a stand-in for the user drives.
class RobotInWindow : public RobotInView {
 protected:
  static constexpr int kWidth = 640, kHeight = 480;

  void SetUp() override {
    if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "DISPLAY is not set";
    if (!std::filesystem::exists(testing::kXdotool)) GTEST_SKIP() << "xdotool is not installed";
    Result<Window> opened = Window::open(model_, kTitle,
                                         {.width = kWidth,
                                          .height = kHeight,
                                          .quality = RenderQuality::low,
                                          .can_target = true,
                                          .jog_dofs = sim_.jog_dofs()});
    ASSERT_TRUE(opened) << opened.error().what;
    window_ = std::make_unique<Window>(std::move(*opened));
    handle_.attach(*window_);
    ASSERT_TRUE(frames_until([] { return id() != ""; })) << "the window does not appear";
    xdotool({"windowmove", "--sync", id(), "0", "0", "windowfocus", "--sync", id()});
    frames(5);
  }
  /// One round of the simulation and of the window, in one thread: nothing depends on the clock.
  void round() {
    for (const ViewEvent& event : window_->take_events()) view_.handle(event);
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
      if (frames_until(holds, 5)) return true;
    }
    return false;
  }
  [[nodiscard]] Eye eye() const {
    return eye_of(window_->view(), model_.raw()->vis.global.fovy * std::numbers::pi / 180);
  }
  [[nodiscard]] Eigen::Vector2d pixel(const Eigen::Vector3d& p_W) const {
    return pixel_of_point(eye(), kWidth, kHeight, p_W).value();
  }
  /// [m] of the handles' arrows.
  [[nodiscard]] double size() const {
    return GizmoOptions{}.size * eye().height_at(target_pose().p);
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
  void take(GizmoHandle handle, const Eigen::Vector3d& p_W) {
    press(pixel(p_W));
    ASSERT_TRUE(frames_until([&] { return handle_.gizmo().held().has_value(); }, 5));
    ASSERT_EQ(*handle_.gizmo().held(), handle);
  }

  static constexpr const char* kTitle = "mjarm robot test";
  testing::Turn turn_;
  TargetHandle handle_{view_.target()->link(), true};
  std::unique_ptr<Window> window_;
};

TEST_F(RobotInWindow, AnArrowMovesTheToolAlongItsAxisOnly) {
  for (const int axis : {0, 2}) {
    const Pose before = target().pose();
    const CameraView camera = window_->view();
    const Eigen::Vector3d along = Eigen::Vector3d::Unit(axis);
    const Eigen::Vector3d held = before.p + 0.9 * size() * along;
    take(static_cast<GizmoHandle>(axis), held);
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
  take(GizmoHandle::turn_z, on_ring(side));
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
  take(GizmoHandle::move_z, held);
  drag_to({pixel(held).x(), 1});
  ASSERT_TRUE(frames_until([&] { return target().grade() == TargetGrade::unreachable; }));
  EXPECT_THAT(frame_.status, HasSubstr("out of reach"));
  EXPECT_EQ(handle_.look().color, color_of(TargetGrade::unreachable));
  const double reached = fk(arm_, view(sim_.goal())).p.z();
  EXPECT_GT(reached, before.p.z());
  EXPECT_LT(reached, target().pose().p.z());
  let_go();
  EXPECT_GT(target_pose().p.z(), reached);
  step(3000);
  EXPECT_NEAR(tool().p.z(), reached, 3e-3);
}

TEST_F(RobotInWindow, TheRestOfThePictureBelongsToTheCamera) {
  const CameraView before = window_->view();
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
    return !std::get<PanelCheckbox>(place("Target", "Follow").item->what).on;
  }));
}

/// As the command runs it: the simulation in a thread of its own.
TEST_F(RobotInWindow, InItsOwnThreadTheArmFollowsAsWell) {
  const Pose before = target_pose();
  const Eigen::Vector3d held = before.p + 0.9 * size() * Eigen::Vector3d::UnitX();
  const Eigen::Vector2d from = pixel(held);
  const Eigen::Vector2d to = pixel(held - 0.1 * Eigen::Vector3d::UnitX());
  ViewLink link;
  std::thread worker([&] { view_.run(link); });
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  const auto timed_out = [&] { return std::chrono::steady_clock::now() >= end; };
  std::thread user([&] {
    xdotool({"mousemove", word(from.x()), word(from.y()), "sleep", "0.3", "mousedown", "1", "sleep",
             "0.3", "mousemove", word(to.x()), word(to.y()), "sleep", "0.3", "mouseup", "1"});
  });
  bool moved = false;
  const Result<void> drawn = draw_until_closed(*window_, link, [&] {
    moved = moved || (!handle_.gizmo().held() && target_pose().p.x() < before.p.x() - 0.05 &&
                      handle_.look().number > 2);
    return moved || timed_out();
  });
  user.join();
  worker.join();
  ASSERT_TRUE(drawn);
  ASSERT_TRUE(moved);
  EXPECT_NEAR(target().pose().p.x(), before.p.x() - 0.1, 0.01);
  EXPECT_LT((target().pose().p - target_pose().p).norm(), 1e-12);
  step(1500);
  expect_there(target().pose());
}

}  // namespace
}  // namespace mjarm::app
