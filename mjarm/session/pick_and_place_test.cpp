#include "mjarm/session/pick_and_place.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <utility>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/session/see_scene.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::session {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kScene = "universal_robots_ur5e/pick.xml";
const Pose kPlace{.p = {0.5, -0.26, 0.236}};  // of the box, in the tray

/// The shipped scene, moved to its start.
struct PickWorldOfTest {
  explicit PickWorldOfTest(const std::string& file = kScene)
      : robot(load_robot(file).value()), sim(robot.model) {
    sim.reset_home();
    sim.hold_others(robot.arm);
  }
  [[nodiscard]] Pose pose(const std::string& body) const {
    return frame_pose(robot.model, body, sim.qpos()).value();
  }
  /// Everything is seen where it is.
  [[nodiscard]] static Result<program::SeenScene> true_look(const SceneState& scene,
                                                            std::span<const double>) {
    return program::SeenScene{.scene = scene};
  }
  Result<PickAndPlaceOutcome> pick(const Look& look, const PickAndPlaceOptions& options = {}) {
    return pick_and_place(robot, sim, look, {.object = "box", .place = program::PlaceGoal{kPlace}},
                          options);
  }

  Robot robot;
  Sim sim;
};

TEST(PickAndPlace, PutsDownWhatItPicksUp) {
  PickWorldOfTest world;
  const auto outcome = world.pick(PickWorldOfTest::true_look);
  ASSERT_TRUE(outcome) << outcome.error().what;
  EXPECT_TRUE(outcome->done);
  ASSERT_EQ(outcome->tries.size(), 1u);
  EXPECT_EQ(outcome->tries.front().what, "");
  EXPECT_LT((world.pose("box").p - kPlace.p).norm(), 5e-3);
}

TEST(PickAndPlace, AThingThatIsElsewhereIsMissedAndPickedUpWithTheNextLook) {
  PickWorldOfTest world;
  int looks = 0;
  const Look look = [&](const SceneState& scene, std::span<const double>) {
    program::SeenScene seen{.scene = scene};
    if (++looks > 1) return Result<program::SeenScene>(std::move(seen));
    Sim wrong(world.robot.model);
    wrong.set_state(scene.qpos, std::vector<double>(world.sim.qvel().size(), 0));
    Pose X_WB = world.pose("box");
    X_WB.p.x() += 0.1;  // 10 cm off: there is nothing
    wrong.place_free("box", X_WB);
    seen.scene.qpos.assign(wrong.qpos().begin(), wrong.qpos().end());
    return Result<program::SeenScene>(std::move(seen));
  };
  const auto outcome = world.pick(look);
  ASSERT_TRUE(outcome) << outcome.error().what;
  ASSERT_EQ(outcome->tries.size(), 2u);
  EXPECT_EQ(outcome->tries[0].fault, GripFault::nothing_held);
  EXPECT_THAT(outcome->tries[0].what, HasSubstr("hold nothing"));
  EXPECT_EQ(outcome->tries[1].fault, GripFault::none);
  EXPECT_TRUE(outcome->done);
  EXPECT_EQ(looks, 2);
  EXPECT_LT((world.pose("box").p - kPlace.p).norm(), 5e-3);
}

TEST(PickAndPlace, WhatIsTornAwayIsNoticedAndPickedUpAgain) {
  PickWorldOfTest world;
  bool torn = false;
  const PickAndPlaceOptions options{.after_step = [&](const Sim&) {
    // High above the table it is put back on it, out of the fingers.
    if (torn || world.pose("box").p.z() < 0.3) return;
    torn = true;
    world.sim.place_free("box", {.p = {0.45, 0.12, 0.23}});
  }};
  const auto outcome = world.pick(PickWorldOfTest::true_look, options);
  ASSERT_TRUE(outcome) << outcome.error().what;
  ASSERT_EQ(outcome->tries.size(), 2u);
  EXPECT_EQ(outcome->tries[0].fault, GripFault::lost);
  EXPECT_TRUE(outcome->done);
  EXPECT_LT((world.pose("box").p - kPlace.p).norm(), 5e-3);
}

TEST(PickAndPlace, AnArmThatIsBlockedStaysWhereItIs) {
  PickWorldOfTest world;
  int forearm = -1;
  const SceneBodies bodies = scene_bodies(world.robot.model, world.robot.arm);
  for (std::size_t b = 0; b < bodies.role.size(); ++b) {
    if (bodies.role[b] == BodyRole::link) forearm = static_cast<int>(b);
  }
  const PickAndPlaceOptions options{.after_step = [&](const Sim& sim) {
    if (sim.time() > 0.5) world.sim.set_external_force(forearm, {0, 400, 0}, {0, 0, 0});
  }};
  const auto outcome = world.pick(PickWorldOfTest::true_look, options);
  ASSERT_TRUE(outcome) << outcome.error().what;
  EXPECT_FALSE(outcome->done);
  ASSERT_EQ(outcome->tries.size(), 1u);
  EXPECT_EQ(outcome->tries.front().fault, GripFault::blocked);
  EXPECT_LT((world.pose("box").p - Eigen::Vector3d(0.42, 0.1, 0.23)).norm(), 1e-3);
}

TEST(PickAndPlace, WhatCannotBeSeenIsNotPickedUp) {
  PickWorldOfTest world;
  const auto outcome = world.pick([&](const SceneState& scene, std::span<const double>) {
    return Result<program::SeenScene>(
        program::SeenScene{.scene = scene, .unseen = {{"box", "it is hidden"}}});
  });
  ASSERT_TRUE(outcome) << outcome.error().what;
  EXPECT_FALSE(outcome->done);
  EXPECT_THAT(outcome->tries, IsEmpty());
  ASSERT_TRUE(outcome->failure);
  EXPECT_EQ(outcome->failure->code, program::PickErrc::not_seen);
  EXPECT_THAT(outcome->failure->what, HasSubstr("it is hidden"));
}

/// Straight above the things, the fingers downwards.
Vantage above_the_things(Look look) {
  return {.X_WT = {.p = {0.49, 0.18, 0.58}, .R = from_euler({std::numbers::pi, 0, 0})},
          .look = std::move(look)};
}

TEST(PickAndPlace, WhatTheFirstLookDoesNotFindIsLookedForFromElsewhere) {
  PickWorldOfTest world;
  int looks = 0;
  const Look blind = [](const SceneState& scene, std::span<const double>) {
    return Result<program::SeenScene>(
        program::SeenScene{.scene = scene, .unseen = {{"box", "it is hidden"}}});
  };
  const Look from_above = [&](const SceneState& scene, std::span<const double> q) {
    ++looks;
    const Pose X_WT = fk(world.robot.arm, q);
    EXPECT_LT((X_WT.p - Eigen::Vector3d(0.49, 0.18, 0.58)).norm(), 1e-3);
    // The can, which the first look found, is hidden now.
    Sim elsewhere(world.robot.model);
    elsewhere.set_state(scene.qpos, std::vector<double>(world.sim.qvel().size(), 0));
    elsewhere.place_free("can", world.pose("box"));
    program::SeenScene seen{.scene = scene, .unseen = {{"can", "it is hidden"}}};
    seen.scene.qpos.assign(elsewhere.qpos().begin(), elsewhere.qpos().end());
    return Result<program::SeenScene>(std::move(seen));
  };
  Vantage out_of_reach = above_the_things(from_above);
  out_of_reach.X_WT.p.x() = 3;
  const auto outcome = world.pick(
      blind, {.vantages = {out_of_reach, above_the_things(from_above), above_the_things(blind)}});
  ASSERT_TRUE(outcome) << outcome.error().what;
  EXPECT_TRUE(outcome->done) << (outcome->failure ? outcome->failure->what : "");
  EXPECT_EQ(looks, 1);
  EXPECT_LT((world.pose("box").p - kPlace.p).norm(), 5e-3);
}

TEST(PickAndPlace, WhatMayHideBesideTheObjectIsLookedForOnce) {
  PickWorldOfTest world;
  int looks = 0;
  const auto hidden = [&](bool counts) {
    return [&looks, counts](const SceneState& scene, std::span<const double>) {
      looks += counts ? 1 : 0;
      return Result<program::SeenScene>(program::SeenScene{
          .scene = scene, .unseen = {{"can", "it is hidden"}}, .anywhere = {"can"}});
    };
  };
  const auto outcome =
      world.pick(hidden(false),
                 {.vantages = {above_the_things(hidden(true)), above_the_things(hidden(true))}});
  ASSERT_TRUE(outcome) << outcome.error().what;
  EXPECT_TRUE(outcome->done) << (outcome->failure ? outcome->failure->what : "");
  EXPECT_EQ(looks, 1);
}

/// How well the shipped camera knows where things are.
TEST(SceneEye, SeesTheThingsOfTheShippedSceneWhereTheyAre) {
  PickWorldOfTest world;
  Result<SceneEye> eye = SceneEye::open(world.robot, "rgbd");
  if (!eye && eye.error().code == Errc::not_available) GTEST_SKIP() << "no OpenGL";
  ASSERT_TRUE(eye) << eye.error().what;
  const std::vector<double> qpos(world.sim.qpos().begin(), world.sim.qpos().end());
  const auto seen = eye->look({.qpos = qpos}, as_span(world.robot.arm.home));
  ASSERT_TRUE(seen) << seen.error().what;
  EXPECT_THAT(seen->unseen, IsEmpty());
  for (const char* name : {"box", "can", "house"}) {
    const Pose found = frame_pose(world.robot.model, name, seen->scene.qpos).value();
    EXPECT_LT((found.p - world.pose(name).p).norm(), 2e-3) << name;
    EXPECT_NE(found.p, world.pose(name).p) << name;
  }
  EXPECT_EQ(seen->same.at("box").size(), 4u);
}

TEST(SceneEye, WhatIsNotThereHasNoPose) {
  PickWorldOfTest world;
  Result<SceneEye> eye = SceneEye::open(world.robot, "rgbd");
  if (!eye && eye.error().code == Errc::not_available) GTEST_SKIP() << "no OpenGL";
  ASSERT_TRUE(eye) << eye.error().what;
  world.sim.place_free("can", {.p = {0, 4, 0.05}});
  const std::vector<double> qpos(world.sim.qpos().begin(), world.sim.qpos().end());
  const auto seen = eye->look({.qpos = qpos}, as_span(world.robot.arm.home));
  ASSERT_TRUE(seen) << seen.error().what;
  ASSERT_EQ(seen->unseen.size(), 1u);
  EXPECT_EQ(seen->unseen.begin()->first, "can");
  EXPECT_EQ(seen->same.count("can"), 0u);
}

TEST(SceneEye, TheOneAtTheWristSeesBehindThings) {
  PickWorldOfTest world;
  Result<SceneEye> eye = SceneEye::open(world.robot, "rgbd");
  Result<SceneEye> wrist = SceneEye::open(world.robot, "wrist");
  if (!eye && eye.error().code == Errc::not_available) GTEST_SKIP() << "no OpenGL";
  ASSERT_TRUE(eye && wrist);
  world.sim.place_free("can", {.p = {0.5, 0.15, 0.25}});
  world.sim.place_free("box", {.p = {0.44, 0.15, 0.22},
                               .R = from_euler({std::numbers::pi / 2, 0, std::numbers::pi / 2})});
  const SceneState truth{.qpos = {world.sim.qpos().begin(), world.sim.qpos().end()},
                         .attached = {}};
  const auto behind = eye->look(truth, as_span(world.robot.arm.home));
  ASSERT_TRUE(behind) << behind.error().what;
  EXPECT_TRUE(behind->unseen.contains("box"));
  const auto above =
      IkSolver(world.robot.arm).solve(above_the_things({}).X_WT, as_span(world.robot.arm.home));
  ASSERT_TRUE(above);
  const auto seen = wrist->look(truth, as_span(above->q));
  ASSERT_TRUE(seen) << seen.error().what;
  EXPECT_THAT(seen->unseen, IsEmpty());
  const Pose found = frame_pose(world.robot.model, "box", seen->scene.qpos).value();
  EXPECT_LT((found.p - world.pose("box").p).norm(), 2e-3);
}

TEST(SceneEye, NamesTheNearestCamera) {
  const PickWorldOfTest world;
  const auto eye = SceneEye::open(world.robot, "rgb");
  ASSERT_FALSE(eye);
  EXPECT_EQ(eye.error().code, Errc::bad_input);
  EXPECT_THAT(eye.error().what, HasSubstr("rgbd"));
}

TEST(SceneEye, WantsSomethingToLookFor) {
  const auto eye = SceneEye::open(load_robot("ur5e").value(), "overview");
  ASSERT_FALSE(eye);
  EXPECT_EQ(eye.error().code, Errc::bad_input);
  EXPECT_THAT(eye.error().what, HasSubstr("free joint"));
}

}  // namespace
}  // namespace mjarm::session
