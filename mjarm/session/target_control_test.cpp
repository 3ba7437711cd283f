#include "mjarm/session/target_control.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/shipped_test.hpp"

namespace mjarm::session {
namespace {

using mjarm::testing::shipped_arm;
using mjarm::testing::TestArm;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class Control : public ::testing::Test {
 protected:
  [[nodiscard]] Pose goal_pose() const { return fk(robot_.arm, as_span(sim_.goal())); }
  void drag(const Eigen::Vector3d& way, bool held = true) {
    Pose X_WT = control_.target().pose();
    X_WT.p += way;
    control_.link().drags.push({{X_WT, held, ++drags_}});
    EXPECT_TRUE(control_.take_drags());
  }
  /// The item with this name.
  view::PanelItem item(const std::string& name) {
    std::vector<view::PanelSection> sections;
    control_.add_sections(sections);
    for (const view::PanelSection& section : sections) {
      for (const view::PanelItem& found : section.items) {
        if (found.name == name) return found;
      }
    }
    ADD_FAILURE() << name;
    return {};
  }
  void use(const std::string& name, double value = 1) {
    EXPECT_TRUE(control_.handle({item(name).id, value})) << name;
  }
  std::string shown(const std::string& name) {
    return std::get<view::PanelText>(item(name).what).value;
  }

  TestArm robot_ = shipped_arm("ur5e");
  FreeSim sim_ = FreeSim::create(robot_.model, robot_.arm, false).value();
  TargetControl control_{robot_.model, robot_.arm, sim_};
  long drags_ = 0;
};

TEST(TargetColors, AreGreenAmberAndRed) {
  EXPECT_GT(color_of(TargetGrade::good).g, 0.7F);
  EXPECT_GT(color_of(TargetGrade::unreachable).r, 0.8F);
  EXPECT_LT(color_of(TargetGrade::unreachable).g, 0.2F);
  EXPECT_EQ(color_of(TargetGrade::jump), color_of(TargetGrade::near_limit));
  EXPECT_EQ(color_of(TargetGrade::near_singular), color_of(TargetGrade::near_limit));
}

TEST_F(Control, OutOfReachTheReasonIsToldInTheLanguageInUse) {
  drag({3, 0, 0});
  EXPECT_EQ(control_.target().grade(), TargetGrade::unreachable);
  EXPECT_THAT(control_.line(), StartsWith("not reachable: out of reach"));
  EXPECT_EQ(shown("State"), "not reachable");
  {
    const LanguageScope chinese(Language::chinese);
    EXPECT_THAT(control_.line(), HasSubstr("不可达"));
    EXPECT_EQ(shown("状态"), "不可达");
  }
  // The arm goes as far as it can, no further.
  EXPECT_GT(goal_pose().p.x(), fk(robot_.arm, as_span(robot_.arm.home)).p.x());
  EXPECT_LT(goal_pose().p.x(), 1.2);
  render::Overlay overlay;
  control_.add_ghost(overlay, false);
  ASSERT_EQ(overlay.ghosts.size(), 1U);
  EXPECT_EQ(overlay.ghosts[0].color.r, color_of(TargetGrade::unreachable).r);
}

TEST_F(Control, NothingDraggedIsNoChange) {
  const JointVec before = sim_.goal();
  EXPECT_FALSE(control_.take_drags());
  EXPECT_EQ(sim_.goal(), before);
}

/// What lies between two looks does not count, however many drags there were.
TEST_F(Control, OnlyTheLastOfManyDragsCounts) {
  const Pose X_home = control_.target().pose();
  std::vector<view::TargetDrag> drags;
  for (int i = 1; i <= 20; ++i) {
    Pose X_WT = X_home;
    X_WT.p.z() += i == 20 ? 0.05 : 5;
    drags.push_back({X_WT, i < 20, i});
  }
  control_.link().drags.push(drags);
  EXPECT_TRUE(control_.take_drags());
  EXPECT_NEAR(goal_pose().p.z(), X_home.p.z() + 0.05, 1e-6);
  control_.post_look();
  view::TargetLook look;
  ASSERT_TRUE(control_.link().looks.take(look));
  EXPECT_EQ(look.number, 20);
}

TEST_F(Control, PutAwayItIsNotDragged) {
  control_.toggle();
  const JointVec before = sim_.goal();
  drag({0, 0, 0.05});
  EXPECT_EQ(sim_.goal(), before);
  EXPECT_EQ(control_.line(), "");
  render::Overlay overlay;
  control_.add_ghost(overlay, false);
  EXPECT_TRUE(overlay.ghosts.empty());
  control_.add_ghost(overlay, true);
  EXPECT_EQ(overlay.ghosts.size(), 1U);
}

TEST_F(Control, AJogThatCannotBeLeavesTheArm) {
  use("Move by", 2);
  for (int i = 0; i < 40; ++i) use("+ y");
  EXPECT_THAT(control_.line(), StartsWith("the target stays: not reachable: "));
  const JointVec before = sim_.goal();
  use("+ y");
  EXPECT_EQ(sim_.goal(), before);
  use("- y");
  EXPECT_NE(sim_.goal(), before);
}

/// Every other posture is a ghost that a click takes; the arm goes there.
TEST_F(Control, OtherPosturesAreGhostsToBeClickedOn) {
  render::Overlay none;
  control_.add_ghost(none, false);
  EXPECT_TRUE(none.ghosts.empty());
  use("All postures");
  render::Overlay overlay;
  control_.add_ghost(overlay, false);
  ASSERT_GE(overlay.ghosts.size(), 2U);
  EXPECT_LE(overlay.ghosts.size(), render::kMaxGhosts);
  const Pose before = goal_pose();
  for (const render::OverlayGhost& ghost : overlay.ghosts) {
    ASSERT_TRUE(control_.handle({ghost.item, ghost.value}));
    EXPECT_EQ(std::vector<double>(sim_.goal().begin(), sim_.goal().end()), ghost.qpos);
    EXPECT_LT((goal_pose().p - before.p).norm(), 1e-6);
  }
  EXPECT_TRUE(control_.handle({overlay.ghosts.front().item, 99}));
  EXPECT_TRUE(control_.handle({overlay.ghosts.front().item, -1}));
  EXPECT_EQ(std::vector<double>(sim_.goal().begin(), sim_.goal().end()),
            overlay.ghosts.back().qpos);
}

TEST_F(Control, PosturesAreListedInWords) {
  use("All postures");
  std::vector<view::PanelSection> sections;
  control_.add_sections(sections);
  ASSERT_EQ(sections.size(), 3U);
  const auto& list = std::get<view::PanelList>(sections[1].items.at(0).what);
  ASSERT_GE(list.lines.size(), 3U);
  EXPECT_EQ(list.current, 0);
  EXPECT_THAT(list.lines[0], HasSubstr("shoulder "));
  EXPECT_THAT(list.lines[0], HasSubstr(", elbow "));
  EXPECT_NE(list.lines[0].substr(1), list.lines[1].substr(1));
  const LanguageScope chinese(Language::chinese);
  std::vector<view::PanelSection> same;
  control_.add_sections(same);
  EXPECT_THAT(std::get<view::PanelList>(same.at(1).items.at(0).what).lines.at(0),
              HasSubstr("、elbow "));
}

TEST_F(Control, PosturesGoAlongWithTheTarget) {
  use("All postures");
  drag({0, 0, 0.05});
  render::Overlay overlay;
  control_.add_ghost(overlay, false);
  ASSERT_GE(overlay.ghosts.size(), 2U);
  for (const render::OverlayGhost& ghost : overlay.ghosts) {
    EXPECT_LT((fk(robot_.arm, ghost.qpos).p - control_.target().pose().p).norm(), 1e-6);
  }
  use("All postures", 0);
  render::Overlay off;
  control_.add_ghost(off, false);
  EXPECT_LE(off.ghosts.size(), 1U);
  std::vector<view::PanelSection> sections;
  control_.add_sections(sections);
  EXPECT_EQ(sections.size(), 2U);
}

TEST_F(Control, ChoicesOutOfRangeAreClampedAndOtherItemsLeftAlone) {
  use("Move by", 99);
  use("Frame", -7);
  const Pose before = control_.target().pose();
  use("+ x");
  EXPECT_NEAR(control_.target().pose().p.x(), before.p.x() + 0.05, 1e-9);
  EXPECT_FALSE(control_.handle({1, 1}));
  EXPECT_FALSE(control_.handle({1200, 1}));
}

}  // namespace
}  // namespace mjarm::session
