#include "mjarm/planning/planning_world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <thread>

#include "mjarm/collision/exact.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/planning/goals_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using testing::goals_at;

constexpr double kPi = std::numbers::pi;

const Robot& walled_ur5e() {
  static const Robot kRobot = load_robot("universal_robots_ur5e/wall.xml").value();
  return kRobot;
}

/// Before and behind the wall, the tool pointing down.
const std::vector<double> kBefore{-4.375, -1.2456, 1.9905, -2.3157, -1.5708, 0};
std::vector<JointVec> behind() {
  return goals_at({{-5.551, -1.2456, 1.9905, -2.3157, -1.5708, 0}});
}
Pose down_at(double x, double y, double z) { return {{x, y, z}, from_euler({kPi, 0, 0})}; }

PlanningWorld world_of(const Robot& robot, WorldOptions options = {}) {
  return PlanningWorld::create(robot, std::move(options)).value();
}

/// [m] the least distance on a path by MuJoCo's own geometry, every 0.005 rad; `reach` where
/// nothing is nearer than that.
double exact_clearance(const Robot& robot, const PlannedPath& path, double reach,
                       const ContactRules& rules = {}) {
  ExactChecker checker(robot.model, robot.arm, {.margin = reach, .rules = rules});
  double least = reach;
  for (std::size_t i = 1; i < path.q.size(); ++i) {
    const JointVec way = path.q[i] - path.q[i - 1];
    const int samples = std::max(2, static_cast<int>(way.norm() / 0.005));
    for (int k = 0; k <= samples; ++k) {
      const auto report = checker.check(as_span(path.q[i - 1] + way * k / samples)).value();
      if (report.nearest) least = std::min(least, report.nearest->distance);
    }
  }
  return least;
}

/// A turning beam with flat sides 40 mm apart, a ball at its end, and a post beside it; `gap` [m]
/// is left between beam and post where the beam stands at 0. One row of balls along the beam sticks
/// out of its sides by 8.3 mm at least.
Robot beam(double gap, const std::string& more = "", const std::string& collide = "") {
  const support::TempFolder folder;
  const std::string xml = R"(<mujoco><compiler angle="radian"/><worldbody>
    <geom name="post" type="box" size="0.05 0.05 0.3" pos="0.5 )" +
                          std::to_string(0.07 + gap) + R"( 0"/>
    <body name="beam"><joint name="turn" axis="0 0 1" range="-3 3" limited="true"/>
      <geom name="beam" type="box" size="0.25 0.02 0.02" pos="0.35 0 0")" +
                          collide + R"(/>
      <body name="tip" pos="0.65 0 0"><joint name="bend" axis="0 1 0" range="-2 2" limited="true"/>
        <geom name="tip" type="sphere" size="0.03" pos="0.06 0 0")" +
                          collide + R"(/>
        <site name="tcp" pos="0.1 0 0"/></body></body>)" +
                          more + R"(</worldbody>
    <actuator><position joint="turn"/><position joint="bend"/></actuator></mujoco>)";
  return load_robot(folder.write("beam.xml", xml).string(), {.tip = "tcp"}).value();
}

TEST(PlanningWorld, PlansToJointsAPoseAndARegion) {
  PlanningWorld world = world_of(walled_ur5e());
  const auto joints = world.plan(kBefore, behind());
  ASSERT_TRUE(joints) << joints.error().what;
  EXPECT_GT(joints->q.size(), 2U);
  EXPECT_EQ(joints->q.front(), joint_vec(kBefore));
  EXPECT_EQ(joints->q.back(), behind().front());
  EXPECT_GT(exact_clearance(walled_ur5e(), *joints, 0.1), 0);

  const Pose X_WT = down_at(-0.3, -0.45, 0.2);
  const auto pose = world.plan(kBefore, X_WT);
  ASSERT_TRUE(pose) << pose.error().what;
  const Pose reached = fk(walled_ur5e().arm, as_span(pose->q.back()));
  EXPECT_LT((reached.p - X_WT.p).norm(), 1e-4);
  EXPECT_LT(angle_between(reached.R, X_WT.R), 1e-3);
  EXPECT_GT(exact_clearance(walled_ur5e(), *pose, 0.1), 0);

  // Out of reach by itself, but not all of the box round it.
  const Pose far = down_at(-0.95, -0.3, 0.2);
  EXPECT_FALSE(world.plan(kBefore, far));
  const auto region = world.plan({.q = {joint_vec(kBefore)}},
                                 {.regions = {region_about(far, {0.4, 0, 0}, 0, kPi)}});
  ASSERT_TRUE(region) << region.error().what;
  const Eigen::Vector3d p_W = fk(walled_ur5e().arm, as_span(region->q.back())).p;
  EXPECT_NEAR(p_W.y(), -0.3, 1e-4);
  EXPECT_LT(p_W.x(), -0.5);

  const auto anyhow =
      world.plan(kBefore, Pose{X_WT.p, Eigen::Matrix3d::Identity()}, {}, IkTask::position);
  ASSERT_TRUE(anyhow) << anyhow.error().what;
  EXPECT_LT((fk(walled_ur5e().arm, as_span(anyhow->q.back())).p - X_WT.p).norm(), 1e-4);
}

TEST(PlanningWorld, CoversOnceAndKeepsWhatItMade) {
  PlanningWorld world = world_of(walled_ur5e());
  const WorldScene* const scene = world.scene().value();
  ASSERT_TRUE(world.plan(kBefore, behind()));
  EXPECT_EQ(world.scene().value(), scene);
}

/// The beam begins beside the post, nearer than its spheres stick out, and ends as near to it.
TEST(PlanningWorld, SpheresAreNotInTheWayOfWhatIsFree) {
  const LanguageScope english(Language::english);
  for (const double gap : {0.005, 0.001, 1e-4}) {
    const Robot robot = beam(gap);
    PlanningWorld world = world_of(robot);
    const FastChecker spheres = world.scene().value()->checker.looking_closer(nullptr);
    const std::vector<double> start{0, 0};
    EXPECT_FALSE(spheres.is_free(start));
    for (const bool back : {false, true}) {
      const auto away = goals_at({{-1, 0.5}});
      const auto path =
          back ? world.plan(as_span(away.front()), goals_at({{0, 0}})) : world.plan(start, away);
      ASSERT_TRUE(path) << gap << ": " << path.error().what;
      EXPECT_GE(exact_clearance(robot, *path, 0.1), gap - 1e-6);
    }
  }
  // What touches, or nearly, is told with what is really left.
  for (const double gap : {-0.002, 1e-5}) {
    PlanningWorld world = world_of(beam(gap));
    const auto hit = world.plan(std::vector<double>{0, 0}, goals_at({{-1, 0.5}}));
    ASSERT_FALSE(hit) << gap;
    EXPECT_EQ(hit.error().code, WorldErrc::no_path);
    EXPECT_EQ(hit.error().search.code, PlanErrc::start_hit);
    EXPECT_NEAR(hit.error().search.pair.distance, gap, 1e-6);
    EXPECT_NE(hit.error().what.find("obstacle \"post\""), std::string::npos) << hit.error().what;
  }
}

TEST(PlanningWorld, ReasonsAreTold) {
  const LanguageScope english(Language::english);
  PlanningWorld world = world_of(walled_ur5e());
  std::vector<double> outside = kBefore;
  outside[2] = 9;
  const auto path = world.plan(outside, behind());
  ASSERT_FALSE(path);
  EXPECT_EQ(path.error().search.code, PlanErrc::start_outside);
  EXPECT_NE(path.error().what.find("outside of the limits"), std::string::npos);
  const auto inside = world.plan(kBefore, down_at(0, -0.45, 0.2));
  ASSERT_FALSE(inside);
  EXPECT_EQ(inside.error().search.code, PlanErrc::goals_hit);
  EXPECT_NE(inside.error().what.find("every goal is in collision"), std::string::npos);
}

/// The turn of the base beyond the wall cannot be undone: the same posture stands a revolution
/// away.
TEST(PlanningWorld, AWindingThatCannotBeReachedHasOneThatCan) {
  const LanguageScope english(Language::english);
  const Robot robot = load_robot("ur5e").value();
  PlanningWorld world = world_of(robot);
  const std::vector<double> start{-1.5708, -1.5708, 1.5708, -1.5708, -1.5708, 0};
  JointVec goal = joint_vec(start);
  goal[1] = -1.2;
  const JointVec near = goal;
  goal[1] += 2 * kPi;  // the upper arm would have to pass through the floor
  const auto none = world.plan(start, std::vector{goal});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().search.code, PlanErrc::barred);
  EXPECT_LE(none.error().search.samples, 2100);  // told at once, by a proof
  EXPECT_NE(none.error().what.find("joint \"shoulder_lift_joint\" would have to pass"),
            std::string::npos)
      << none.error().what;
  ASSERT_EQ(none.error().same_posture.size(), 6);
  EXPECT_LT((none.error().same_posture - near).norm(), 1e-9);
  EXPECT_NE(none.error().what.find("same posture"), std::string::npos) << none.error().what;
  EXPECT_NE(none.error().what.find("-1.2,"), std::string::npos) << none.error().what;
  EXPECT_TRUE(world.plan(start, std::vector{none.error().same_posture}));
}

/// Of two goals the nearer one is beside the post, nearer than spheres stick out.
TEST(PlanningWorld, SpheresDoNotHideTheNearestGoal) {
  const Robot robot = beam(0.002);
  PlanningWorld world = world_of(robot);
  const std::vector<double> start{-0.8, 0.3};
  const auto goals = goals_at({{-2.9, 0}, {0, 0}});
  EXPECT_FALSE(world.scene().value()->checker.looking_closer(nullptr).is_free(as_span(goals[1])));
  const auto path = world.plan(start, goals);
  ASSERT_TRUE(path) << path.error().what;
  EXPECT_EQ(path->goal, 1);
}

TEST(PlanningWorld, WhatCannotBeAskedHasAReason) {
  const LanguageScope english(Language::english);
  PlanningWorld world = world_of(walled_ur5e());
  const auto far = world.plan(kBefore, down_at(3, 0, 0));
  ASSERT_FALSE(far);
  EXPECT_EQ(far.error().code, WorldErrc::no_answer);
  EXPECT_NE(far.error().what.find("out of reach"), std::string::npos) << far.error().what;
  for (const auto& path :
       {world.plan(kBefore, std::vector<JointVec>{}), world.plan({kBefore.data(), 5}, behind()),
        world.plan(kBefore, goals_at({{1, 2, 3}}))}) {
    ASSERT_FALSE(path);
    EXPECT_EQ(path.error().search.code, PlanErrc::bad_input);
    EXPECT_NE(path.error().what.find("6 finite joint values"), std::string::npos);
  }
  EXPECT_EQ(world.plan({kBefore.data(), 5}, down_at(-0.3, -0.45, 0.2)).error().code,
            WorldErrc::no_answer);

  const Robot ghost = beam(0.1, "", " contype=\"0\" conaffinity=\"0\"");
  PlanningWorld nothing = world_of(ghost);
  const auto path = nothing.plan(std::vector<double>{0, 0}, goals_at({{1, 0}}));
  ASSERT_FALSE(path);
  EXPECT_EQ(path.error().code, WorldErrc::bad_model);
  EXPECT_EQ(path.error().what, nothing.scene().error().what);
}

TEST(PlanningWorld, OptionsOutOfRangeAreRefused) {
  const LanguageScope english(Language::english);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto why = [](const WorldOptions& options) {
    const auto world = PlanningWorld::create(walled_ur5e(), options);
    return world ? std::string() : world.error().what;
  };
  for (const double margin : {-1e-9, 0.51, nan}) {
    EXPECT_NE(why({.margin = margin}).find("margin"), std::string::npos) << margin;
  }
  EXPECT_NE(why({.rules = {.attached = {{"wall", {}}}}}).find("no free joint"), std::string::npos);
  EXPECT_NE(why({.rules = {.allowed = {{{"wall", "flor"}}}}}).find("\"floor\""), std::string::npos);
}

/// Every configuration of a path keeps the margin in exact geometry, at both ends too.
TEST(PlanningWorld, PathsKeepTheMargin) {
  const LanguageScope english(Language::english);
  constexpr double kMargin = 0.02;
  PlanningWorld tight = world_of(walled_ur5e()),
                wide = world_of(walled_ur5e(), {.margin = kMargin});
  const Pose X_WT = down_at(-0.3, -0.45, 0.2);
  const auto near = tight.plan(kBefore, X_WT), far = wide.plan(kBefore, X_WT);
  ASSERT_TRUE(near) << near.error().what;
  ASSERT_TRUE(far) << far.error().what;
  EXPECT_GE(exact_clearance(walled_ur5e(), *far, 0.1), kMargin);
  // Beside the post there is room for 30 mm.
  const Robot robot = beam(0.03);
  const std::vector<double> start{-1, 0};
  const auto goals = goals_at({{0, 0}});
  PlanningWorld bare = world_of(robot);
  const auto beside = bare.plan(start, goals);
  ASSERT_TRUE(beside);
  EXPECT_NEAR(exact_clearance(robot, *beside, 0.1), 0.03, 1e-6);
  PlanningWorld kept = world_of(robot, {.margin = 0.025});
  const auto clear = kept.plan(start, goals);
  ASSERT_TRUE(clear) << clear.error().what;
  EXPECT_GE(exact_clearance(robot, *clear, 0.1), 0.025);
  // Where the margin is wider than the room there is no path, and it is told what is too near.
  PlanningWorld too_wide = world_of(robot, {.margin = 0.031});
  const auto none = too_wide.plan(start, goals);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().search.code, PlanErrc::goals_hit);
  EXPECT_NE(none.error().what.find("obstacle \"post\""), std::string::npos) << none.error().what;
}

/// A rod at the tip, taken along, needs more room; a plate that it stands on is allowed to touch.
TEST(PlanningWorld, AttachedBodiesCountAndAllowedPairsDoNot) {
  const Robot robot = beam(0.1, R"(
    <geom name="plate" type="box" size="0.1 0.1 0.01" pos="0.75 0 -0.11"/>
    <body name="rod" pos="0.75 0 0"><freejoint/>
      <geom name="rod" type="box" size="0.01 0.01 0.101"/></body>)");
  const std::vector<double> start{0, 0};
  const auto goals = goals_at({{-1.5, 0}});
  const AttachedBody rod = attach_in_place(robot.model, robot.arm, "rod", start).value();
  PlanningWorld held = world_of(robot, {.rules = {.attached = {rod}}});
  const auto stuck = held.plan(start, goals);
  ASSERT_FALSE(stuck);
  EXPECT_EQ(stuck.error().search.code, PlanErrc::start_hit);
  const ContactRules rules{.attached = {rod}, .allowed = {{{"rod", "plate"}}}};
  PlanningWorld allowed = world_of(robot, {.rules = rules});
  const auto path = allowed.plan(start, goals);
  ASSERT_TRUE(path) << path.error().what;
  EXPECT_GT(exact_clearance(robot, *path, 0.1, rules), 0);
}

TEST(PlanningWorld, SamePathsForCopiesAndFromOtherThreads) {
  PlanningWorld world = world_of(walled_ur5e());
  const auto first = world.plan(kBefore, behind(), {.seed = 3});
  ASSERT_TRUE(first);
  PlanningWorld copy = world;
  std::vector<JointVec> elsewhere;
  std::thread([&] {
    const auto path = copy.plan(kBefore, behind(), {.seed = 3});
    if (path) elsewhere = path->q;
  }).join();
  EXPECT_EQ(elsewhere, first->q);
  EXPECT_EQ(world.plan(kBefore, behind(), {.seed = 3})->q, first->q);
  EXPECT_EQ(world_of(walled_ur5e()).plan(kBefore, behind(), {.seed = 3})->q, first->q);
  PlanTimes times;
  ASSERT_TRUE(world.plan(kBefore, behind(), {.seed = 3}, &times));
  EXPECT_GT(times.search_us, 0);
  EXPECT_GT(times.finish_us, 0);
}

}  // namespace
}  // namespace mjarm
