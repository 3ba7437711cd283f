#include "mjarm/session/robot_session_test.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>
#include <numbers>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm::session {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

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
  const view::ViewFrame& red = frame();
  EXPECT_THAT(red.status, HasSubstr("not reachable: out of reach"));
  ASSERT_EQ(red.overlay.ghosts.size(), 1U);
  EXPECT_GT(red.overlay.ghosts[0].color.r, 0.8F);
  view::TargetLook look;
  ASSERT_TRUE(view_.target()->link().looks.take(look));
  EXPECT_EQ(look.X_WT.p, X_far.p);
  EXPECT_EQ(look.number, drags_);
  EXPECT_EQ(look.color, color_of(TargetGrade::unreachable));
  drag(X_far, false);
  step(4000);
  expect_there(fk(arm_, as_span(sim_.goal())));
  EXPECT_LT(tool().p.x(), 1);
  EXPECT_EQ(shown("Target", "State"), "not reachable");
}

TEST_F(RobotInView, SlidersResetsAndStepsBackTakeTheTargetAlong) {
  view_.handle(view::JointEvent{arm_.joints[0].dof, "pan", 0.3});
  EXPECT_EQ(target().goal()[0], 0.3);
  EXPECT_LT((target().pose().p - fk(arm_, as_span(sim_.goal())).p).norm(), 1e-12);
  step(20);
  use("Tool", "+ x");
  const JointVec after = target().goal();
  step(5);
  for (int i = 0; i < 10; ++i) view_.handle(view::StepEvent{-1});
  EXPECT_NE(target().goal(), after);
  EXPECT_EQ(target().goal()[0], 0.3);
  view_.handle(view::ResetEvent{});
  EXPECT_EQ(target().goal(), arm_.home);
}

TEST_F(RobotInView, TheKeyPutsTheTargetAway) {
  const auto look = [this] {
    view_.fill(frame_);
    view::TargetLook taken;
    EXPECT_TRUE(view_.target()->link().looks.take(taken));
    return taken;
  };
  EXPECT_TRUE(look().shown);
  EXPECT_FALSE(frame_.status.empty());
  view_.handle(view::TargetEvent{});
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
  view_.handle(view::JointEvent{arm_.joints[2].dof, "elbow", 3.1});
  step(3000);
  EXPECT_FALSE(frame().overlay.spheres.empty());
  use("Show", "Contacts", 0);
  EXPECT_TRUE(frame().overlay.spheres.empty());
}

TEST_F(RobotInView, TheTrailIsALineOrBallsOrOff) {
  view_.handle(view::JointEvent{arm_.joints[0].dof, "pan", 0.5});
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

TEST(RobotSession, WithoutAHeldArmThereIsNoTarget) {
  const Model model = Model::load(find_model_file("ur5e").value()).value();
  const Arm arm = find_arm(model).value();
  FreeSim passive = FreeSim::create(model, arm, true).value();
  RobotSession view(model, arm, passive);
  EXPECT_EQ(view.target(), nullptr);
  for (int i = 0; i < 20; ++i) view.step();
  view::ViewFrame frame;
  view.fill(frame);
  EXPECT_EQ(frame.panels.size(), 2U);
  EXPECT_TRUE(frame.status.empty());

  const Model car = Model::load(find_model_file("car").value()).value();
  FreeSim driving = FreeSim::create(car, std::nullopt, false).value();
  RobotSession bare(car, std::nullopt, driving);
  bare.step();
  bare.handle(view::PanelEvent{1000, 1});
  bare.handle(view::TargetEvent{});
  bare.fill(frame);
  EXPECT_TRUE(frame.panels.empty());
}

/// In Chinese every word of the panels is Chinese; names of the model, units and axes stay.
TEST_F(RobotInView, ThePanelsSpeakTheLanguageInUse) {
  const LanguageScope chinese(Language::chinese);
  const auto is_translated = [](const std::string& text) {
    static constexpr const char* kSame[] = {" mm", " rad", "[mm]", "_joint"};
    const bool word = std::ranges::count_if(text, [](char c) { return std::isalpha(c) != 0; }) > 2;
    return !word || std::ranges::any_of(text, [](char c) { return (c & 0x80) != 0; }) ||
           std::ranges::any_of(
               kSame, [&](const char* same) { return text.find(same) != std::string::npos; });
  };
  int items = 0;
  for (const view::PanelSection& section : frame().panels) {
    EXPECT_TRUE(is_translated(section.title)) << section.title;
    for (const view::PanelItem& item : section.items) {
      ++items;
      EXPECT_TRUE(is_translated(item.name)) << item.name;
      EXPECT_EQ(item.name.find(", "), std::string::npos) << item.name;
      if (const auto* line = std::get_if<view::PanelText>(&item.what)) {
        EXPECT_TRUE(is_translated(line->value)) << line->value;
      } else if (const auto* choice = std::get_if<view::PanelChoice>(&item.what)) {
        for (const std::string& word : choice->words) EXPECT_TRUE(is_translated(word)) << word;
      }
    }
  }
  EXPECT_GT(items, 30);
  EXPECT_TRUE(is_translated(frame().status)) << frame().status;
  EXPECT_FALSE(frame().status.empty());
}

}  // namespace
}  // namespace mjarm::session
