// Plans from and to regions of the tool, and within one.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/planning/covered_arm_test.hpp"
#include "mjarm/planning/planning_world.hpp"
#include "mjarm/planning/verify_path.hpp"

namespace mjarm {
namespace {

constexpr double kDeg = std::numbers::pi / 180;

Pose down(double x, double y, double z) {
  return {{x, y, z}, from_euler({std::numbers::pi, 0, 0})};
}

const Robot& robot_and_wall() {
  static const Robot kRobot = load_robot("universal_robots_ur5e/wall.xml").value();
  return kRobot;
}

PlanningWorld walled_world() { return PlanningWorld::create(robot_and_wall()).value(); }

const Arm& walled_robot() { return testing::walled_arm().robot.arm; }

/// With the elbow up.
PathEnd at(const Pose& X_WT) {
  const std::vector<double> before{-4.375, -1.2456, 1.9905, -2.3157, -1.5708, 0};
  return {.q = {IkSolver(walled_robot()).solve(X_WT, before)->q}};
}

TEST(RegionPlan, GoesToTheRegionThatCanBeReachedAndSaysWhich) {
  PlanningWorld world = walled_world();
  // Above reach, in the wall, and behind it.
  const PathEnd goal{.regions = {region_about(down(-0.3, -0.45, 2), {0.1, 0.1, 0.1}),
                                 region_about(down(0, -0.45, 0.15), {0.02, 0.1, 0.02}, 0, 1),
                                 region_about(down(-0.3, -0.45, 0.2), {0.03, 0.03, 0}, 0.1, 1)}};
  const auto path = world.plan(at(down(0.3, -0.45, 0.2)), goal);
  ASSERT_TRUE(path) << path.error().what;
  EXPECT_EQ(path->goal_region, 2);
  EXPECT_EQ(path->start_region, -1);
  EXPECT_TRUE(room_in(goal.regions[2], fk(walled_robot(), as_span(path->q.back()))).within(1e-6));
  testing::expect_free_exactly(testing::walled_arm(), *path);
  // The other way round: any start of two regions will do.
  const auto back = world.plan(goal, at(down(0.3, -0.45, 0.2)));
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_EQ(back->start_region, 2);
  EXPECT_TRUE(room_in(goal.regions[2], fk(walled_robot(), as_span(back->q.front()))).within(1e-6));
  // Nowhere.
  const LanguageScope english(Language::english);
  const auto none = world.plan({.regions = {goal.regions[0], goal.regions[0]}}, goal);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().what.find("the start: none of 2 regions"), 0u) << none.error().what;
}

TEST(RegionPlan, EndsInARegionAreAsNearAsTheyCanBe) {
  PlanningWorld world = walled_world();
  const PathEnd start = at(down(0.3, -0.45, 0.3));
  const TaskRegion box = region_about(down(0.4, -0.35, 0.5), {0.1, 0.1, 0.1}, 0.3, 2);
  const auto path = world.plan(start, {.regions = {box}});
  ASSERT_TRUE(path) << path.error().what;
  EXPECT_TRUE(room_in(box, fk(walled_robot(), as_span(path->q.back()))).within(1e-6));
  // Nearer than any of a hundred poses that are drawn.
  Rng rng(1);
  const IkSolver ik(walled_robot());
  for (int k = 0; k < 100; ++k) {
    const auto drawn = ik.solve(draw_from(box, {0, 0, 0}, 1, rng), as_span(start.q.front()));
    if (!drawn) continue;
    EXPECT_LT(path->cost, 1.02 * (drawn->q - start.q.front()).norm());
  }
}

TEST(RegionPlan, DrawsMoreWhereTheFirstPosesAreInTheWay) {
  PlanningWorld world = walled_world();
  // A box in the wall, of which but the top is free: of the first 16 poses none.
  const PathEnd goal{.regions = {region_about(down(0, -0.5, 0.2), {0.02, 0.1, 0.215}, 0.1, 1)}};
  const PlanOptions patient{.time_limit = 0};
  const auto path = world.plan(at(down(0.3, -0.45, 0.3)), goal, patient);
  ASSERT_TRUE(path) << path.error().what;
  const auto again = world.plan(at(down(0.3, -0.45, 0.3)), goal, patient);
  EXPECT_EQ(again->q, path->q);
}

/// Above the wall, where the hand keeps its heading.
TaskRegion layer_over_the_wall() {
  return region_about(down(0, -0.45, 0.45), {kFreePlace, 0.06, 0.04}, 5 * kDeg, 10 * kDeg);
}

TEST(RegionPlan, StaysWithinARegionAllTheWay) {
  PlanningWorld world = walled_world();
  const TaskRegion layer = layer_over_the_wall();
  const PathEnd start = at(down(0.3, -0.45, 0.45)),
                goal{.regions = {region_about(down(-0.3, -0.45, 0.45))}};
  const auto path = world.plan(start, goal, {.within = layer});
  ASSERT_TRUE(path) << path.error().what;
  testing::expect_free_exactly(testing::walled_arm(), *path);
  RegionRoom least;
  for (std::size_t i = 1; i < path->q.size(); ++i) {
    for (int k = 0; k <= 100; ++k) {
      const JointVec q = path->q[i - 1] + k / 100.0 * (path->q[i] - path->q[i - 1]);
      const RegionRoom room = room_in(layer, fk(walled_robot(), as_span(q)));
      least = {std::min(least.place, room.place), std::min(least.turn, room.turn)};
    }
  }
  EXPECT_TRUE(path->room.within(1e-9));
  EXPECT_LE(path->room.place, least.place + 1e-9);
  EXPECT_LE(path->room.turn, least.turn + 1e-7);
  // The path without does not.
  const auto plain = world.plan(start, goal);
  ASSERT_TRUE(plain);
  GivenPath given;
  given.within = GivenRegion{layer, {0, 0}};
  const auto verdict = [&](const PlannedPath& of) {
    given.rows.clear();
    for (const JointVec& q : of.q) given.rows.emplace_back(q.begin(), q.end());
    return verify_path(robot_and_wall(), {}, given, {}).value();
  };
  const PathVerdict refused = verdict(*plain);
  ASSERT_EQ(refused.faults.size(), 1u);
  EXPECT_STREQ(refused.faults.front().kind, "region");
  given.within->room = path->room;
  EXPECT_TRUE(verdict(*path).faults.empty());
  given.within->room.place = least.place + 1e-4;  // more than is true
  EXPECT_EQ(verdict(*path).faults.size(), 1u);
}

TEST(RegionPlan, SaysHowFarOutsideItsEndsAre) {
  const LanguageScope english(Language::english);
  PlanningWorld world = walled_world();
  const PathEnd inside = at(down(0.3, -0.45, 0.45)), low = at(down(0.3, -0.45, 0.4));
  const auto start = world.plan(low, inside, {.within = layer_over_the_wall()});
  ASSERT_FALSE(start);
  EXPECT_NE(start.error().what.find("10 mm and 0 rad outside"), std::string::npos)
      << start.error().what;
  const auto goal = world.plan(inside, low, {.within = layer_over_the_wall()});
  ASSERT_FALSE(goal);
  EXPECT_EQ(goal.error().search.code, PlanErrc::goals_off);
  TaskRegion narrow = layer_over_the_wall();
  narrow.place_max[2] = narrow.place_min[2];
  const auto bad = world.plan(inside, low, {.within = narrow});
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().search.code, PlanErrc::bad_region);
}

}  // namespace
}  // namespace mjarm
