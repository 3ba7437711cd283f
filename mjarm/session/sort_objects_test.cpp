#include "mjarm/session/sort_objects.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "mjarm/core/rotation.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/session/see_scene.hpp"

namespace mjarm::session {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

const Eigen::Vector3d kBoxSpot{0.44, -0.3, 0.206}, kCanSpot{0.56, -0.3, 0.206};  // in the tray

/// The shipped table with box, can and house, each of which has a name for all that is seen.
struct SortWorldOfTest {
  SortWorldOfTest()
      : robot(load_robot("universal_robots_ur5e/pick.xml").value()), sim(robot.model) {
    sim.reset_home();
    sim.hold_others(robot.arm);
  }
  [[nodiscard]] Pose pose(const std::string& body) const {
    return frame_pose(robot.model, body, sim.qpos()).value();
  }
  /// Everything is seen where it is, but for what is hidden.
  [[nodiscard]] Look looking(std::map<std::string, std::string> hidden = {}) {
    return [this, hidden = std::move(hidden)](const SceneState& scene, std::span<const double>) {
      ++looks;
      return Result<program::SeenScene>(program::SeenScene{.scene = scene, .unseen = hidden});
    };
  }

  Robot robot;
  Sim sim;
  int looks = 0;
};

TEST(SortObjects, PutsEachOverItsSpotAsItRests) {
  SortWorldOfTest world;
  world.sim.place_free("can",  // on its side
                       {.p = {0.52, 0.2, 0.228}, .R = from_euler({std::numbers::pi / 2, 0, 0.4})});
  const std::vector<SortBin> bins{{{"box"}, {kBoxSpot}}, {{"can"}, {kCanSpot}}};
  std::vector<std::string> told;
  const auto outcome = sort_objects(
      world.robot, world.sim, world.looking(), bins,
      {.after_object = [&](const SortedObject& object) { told.push_back(object.name); }});
  ASSERT_TRUE(outcome) << outcome.error().what;
  EXPECT_EQ(outcome->placed(), 2u) << outcome->objects[0].what << outcome->objects[1].what;
  EXPECT_EQ(outcome->tries.size(), 2u);
  EXPECT_EQ(world.looks, 3);
  EXPECT_EQ(told.size(), 2u);
  const Pose box = world.pose("box"), can = world.pose("can");
  EXPECT_LT((box.p - kBoxSpot - Eigen::Vector3d(0, 0, 0.03)).norm(), 2e-3);
  EXPECT_LT((can.p - kCanSpot - Eigen::Vector3d(0, 0, 0.028)).norm(), 2e-3);
  // Its axis was brought along x or y.
  EXPECT_GT(can.R.col(2).cwiseAbs().head<2>().maxCoeff(), 0.999);
  EXPECT_LT((world.pose("house").p - Eigen::Vector3d(0.6, 0.08, 0.23)).norm(), 1e-3);
}

TEST(SortObjects, WhatLiesAtASpotStaysAndWhatCannotBeHadIsLeft) {
  SortWorldOfTest world;
  world.sim.place_free("box", {.p = kBoxSpot + Eigen::Vector3d(0.01, 0, 0.03)});
  world.sim.place_free("house", {.p = {0, 4, 0.03}});
  const std::vector<SortBin> bins{{{"box", "can"}, {kBoxSpot}}, {{"house"}, {kCanSpot}}};
  const auto outcome = sort_objects(world.robot, world.sim, world.looking(), bins);
  ASSERT_TRUE(outcome) << outcome.error().what;
  EXPECT_EQ(outcome->placed(), 1u);
  EXPECT_EQ(outcome->objects[0].spot, 0u);
  EXPECT_EQ(outcome->objects[0].what, "");
  EXPECT_FALSE(outcome->objects[1].spot);
  EXPECT_THAT(outcome->objects[1].what, HasSubstr("none of the 1 spots"));
  EXPECT_EQ(outcome->objects[2].bin, 1u);
  EXPECT_THAT(outcome->objects[2].what, HasSubstr("grasp_out_of_reach"));
  EXPECT_THAT(outcome->tries, IsEmpty());
  EXPECT_EQ(world.sim.time(), 0);
}

TEST(SortObjects, WhatIsHiddenIsLookedForFromElsewhereAndLeftWithItsReason) {
  SortWorldOfTest world;
  const Look hidden = world.looking({{"can", "it is hidden"}});
  int elsewhere = 0;
  const Vantage here{.X_WT = world.sim.tool(world.robot.arm),
                     .look = [&](const SceneState& scene, std::span<const double> q) {
                       ++elsewhere;
                       return hidden(scene, q);
                     }};
  const std::vector<SortBin> bins{{{"can"}, {kCanSpot}}};
  const auto outcome =
      sort_objects(world.robot, world.sim, hidden, bins, {.pick = {.vantages = {here}}});
  ASSERT_TRUE(outcome) << outcome.error().what;
  EXPECT_EQ(outcome->placed(), 0u);
  EXPECT_THAT(outcome->objects[0].what, HasSubstr("it is hidden"));
  EXPECT_EQ(elsewhere, 1);
}

// Along x, as it lies, the fence would be in the way of the opening fingers.
TEST(SortObjects, WhatFitsAtNoSpotAsItLiesIsTurned) {
  SortWorldOfTest world;
  world.sim.place_free("can", {.p = {0.52, 0.2, 0.228},
                               .R = from_euler({std::numbers::pi / 2, 0, std::numbers::pi / 2})});
  const std::vector<SortBin> bins{{{"can"}, {{0.5, 0.012, 0.2}}}};
  const auto outcome =
      sort_objects(world.robot, world.sim, world.looking(), bins,
                   {.pick = {.pick = {.stop = [&] { return world.sim.time() > 0; }}}});
  ASSERT_TRUE(outcome) << outcome.error().what;
  ASSERT_EQ(outcome->tries.size(), 1u) << outcome->objects[0].what;
  const Pose& planned = *outcome->tries[0].planned.X_WB_place;
  EXPECT_GT(std::abs(planned.R.col(2).y()), 0.999);
  EXPECT_LT((planned.p - Eigen::Vector3d(0.5, 0.012, 0.228)).norm(), 1e-3);
}

TEST(SortObjects, AStopEndsItAndSaysSo) {
  SortWorldOfTest world;
  const auto outcome = sort_objects(
      world.robot, world.sim, world.looking(), std::vector<SortBin>{{{"box", "can"}, {kBoxSpot}}},
      {.pick = {.pick = {.stop = [&] { return world.sim.time() > 0.1; }}}});
  ASSERT_TRUE(outcome) << outcome.error().what;
  EXPECT_EQ(outcome->placed(), 0u);
  EXPECT_LT(world.sim.time(), 1);
  for (const SortedObject& object : outcome->objects) EXPECT_NE(object.what, "") << object.name;
}

TEST(SortObjects, ObjectsAndOptionsThatCannotBeAreNamed) {
  SortWorldOfTest world;
  const auto why = [&](const std::string& object, const SortOptions& options = {}) {
    const auto outcome = sort_objects(world.robot, world.sim, world.looking(),
                                      std::vector<SortBin>{{{object}, {kBoxSpot}}}, options);
    return outcome ? std::string() : outcome.error().what;
  };
  EXPECT_THAT(why("boxx"), HasSubstr("\"box\""));
  EXPECT_THAT(why("tray"), HasSubstr("free joint"));
  EXPECT_THAT(why("box", {.at_spot = 0}), HasSubstr("at_spot"));
  EXPECT_THAT(why("box", {.chances = 0}), HasSubstr("chances"));
  EXPECT_EQ(world.looks, 0);
}

/// Each of ten things of two kinds has the name of the body that stands there.
TEST(SceneEye, NamesThingsOfOneKindAsTheSimulationDoes) {
  const Robot robot = load_robot("franka_emika_panda/sort.xml").value();
  Result<SceneEye> eye = SceneEye::open(robot, "rgbd");
  if (!eye && eye.error().code == Errc::not_available) GTEST_SKIP() << "no OpenGL";
  ASSERT_TRUE(eye) << eye.error().what;
  Sim sim(robot.model);
  sim.reset_home();
  sim.place_free("cube1", {.p = {0.38, 0.14, 0.218}});
  sim.place_free("cube5", {.p = {0.38, -0.14, 0.218}});
  const SceneState truth{.qpos = {sim.qpos().begin(), sim.qpos().end()}, .attached = {}};
  const auto seen = eye->look(truth, as_span(robot.arm.home));
  ASSERT_TRUE(seen) << seen.error().what;
  EXPECT_THAT(seen->unseen, IsEmpty());
  EXPECT_EQ(seen->same.at("cube3").size(), 24u);
  for (const std::string kind : {"cube", "can"}) {
    for (int k = 1; k <= 5; ++k) {
      const std::string name = kind + std::to_string(k);
      const Pose found = frame_pose(robot.model, name, seen->scene.qpos).value();
      const Pose X_WB = frame_pose(robot.model, name, truth.qpos).value();
      EXPECT_LT((found.p - X_WB.p).norm(), 2e-3) << name;
      EXPECT_NE(found.p, X_WB.p) << name;
    }
  }
}

TEST(SceneEye, WhatIsHiddenNowStandsWhereItWasLastSeen) {
  SortWorldOfTest world;
  Result<SceneEye> eye = SceneEye::open(world.robot, "rgbd");
  if (!eye && eye.error().code == Errc::not_available) GTEST_SKIP() << "no OpenGL";
  ASSERT_TRUE(eye) << eye.error().what;
  const auto look = [&] {
    const SceneState truth{.qpos = {world.sim.qpos().begin(), world.sim.qpos().end()},
                           .attached = {}};
    return eye->look(truth, as_span(world.robot.arm.home)).value();
  };
  world.sim.place_free("box", {.p = {0.44, 0.15, 0.22},
                               .R = from_euler({std::numbers::pi / 2, 0, std::numbers::pi / 2})});
  ASSERT_THAT(look().unseen, IsEmpty());
  world.sim.place_free("can", {.p = {0.5, 0.15, 0.25}});  // before the box
  const program::SeenScene seen = look();
  EXPECT_TRUE(seen.unseen.contains("box"));
  const Pose believed = frame_pose(world.robot.model, "box", seen.scene.qpos).value();
  EXPECT_LT((believed.p - world.pose("box").p).norm(), 2e-3);
}

}  // namespace
}  // namespace mjarm::session
