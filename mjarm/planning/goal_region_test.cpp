#include "mjarm/planning/goal_region.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/planning/covered_arm_test.hpp"

namespace mjarm {
namespace {

using std::numbers::pi;

const Pose kBehindWall{{-0.3, -0.45, 0.2}, from_euler({pi, 0, 0})};

const JointVec& near() { return testing::walled_arm().robot.arm.home; }

Result<std::vector<JointVec>, IkFailure> goals_of(const GoalRegion& region,
                                                  const GoalOptions& options = {},
                                                  IkTask task = IkTask::pose) {
  const testing::CoveredArm& arm = testing::walled_arm();
  const IkSolver ik(arm.robot.arm, {.task = task});
  return goals_in(arm.checker, ik, region, as_span(near()), options);
}

Pose tool(const JointVec& q) { return fk(testing::walled_arm().robot.arm, as_span(q)); }

TEST(GoalRegion, APoseIsAllItsBranchesThatAreFreeNearestFirst) {
  const auto goals = goals_of({.X_WR = kBehindWall});
  ASSERT_TRUE(goals);
  EXPECT_GT(goals->size(), 8u);  // branches and windings
  EXPECT_LE(goals->size(), 64u);
  double before = 0;
  for (const JointVec& q : *goals) {
    EXPECT_LT((tool(q).p - kBehindWall.p).norm(), 1e-6);
    EXPECT_LT(angle_between(tool(q).R, kBehindWall.R), 1e-6);
    EXPECT_TRUE(testing::walled_arm().checker.is_free(as_span(q)));
    const double far = (q - near()).norm();
    EXPECT_GE(far, before);
    before = far;
  }
  const auto few = goals_of({.X_WR = kBehindWall}, {.max = 3});
  ASSERT_TRUE(few);
  ASSERT_EQ(few->size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ((*few)[k], (*goals)[k]);
}

TEST(GoalRegion, PosesAreDrawnFromTheWholeRegionAndNoOther) {
  GoalRegion region{kBehindWall, {0.1, 0.05, 0.02}, 0.3, 0.5};
  region.X_WR.R = from_euler({pi - 0.2, 0.1, 0.4});
  const auto goals = goals_of(region, {.poses = 60, .max = 4000});
  ASSERT_TRUE(goals);
  Eigen::Vector3d widest = Eigen::Vector3d::Zero();
  double max_lean = 0;
  for (const JointVec& q : *goals) {
    const Pose X_RT = region.X_WR.inverse() * tool(q);
    for (int k = 0; k < 3; ++k) {
      EXPECT_LE(std::abs(X_RT.p[k]), region.half[k] + 1e-6);
      widest[k] = std::max(widest[k], std::abs(X_RT.p[k]) / region.half[k]);
    }
    const double lean = std::acos(std::clamp(X_RT.R(2, 2), -1.0, 1.0));
    EXPECT_LE(lean, region.lean + 1e-6);
    max_lean = std::max(max_lean, lean);
  }
  EXPECT_GT(widest.minCoeff(), 0.8);
  EXPECT_GT(max_lean, 0.2);
  const auto again = goals_of(region, {.poses = 60, .max = 4000});
  EXPECT_EQ(*goals, *again);
}

TEST(GoalRegion, ReachesWhereItsMiddleCannotBeReached) {
  GoalRegion region{{{-0.95, -0.3, 0.2}, from_euler({pi, 0, 0})}};
  const auto none = goals_of(region);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, IkErrc::out_of_reach);
  region.half = {0.4, 0, 0};
  EXPECT_TRUE(goals_of(region));
}

TEST(GoalRegion, WhereAllCollidesTheyAreGivenSoThatThePlannerSaysWithWhat) {
  const testing::CoveredArm& arm = testing::walled_arm();
  const Pose inside{{0, -0.45, 0.2}, from_euler({pi, 0, 0})};
  const auto goals = goals_of({.X_WR = inside});
  ASSERT_TRUE(goals);
  for (const JointVec& q : *goals) EXPECT_FALSE(arm.checker.is_free(as_span(q)));
  const auto path = plan_path(arm.checker, as_span(near()), std::span(*goals).first(1));
  ASSERT_FALSE(path);
  EXPECT_EQ(path.error().code, PlanErrc::goals_hit);
}

TEST(GoalRegion, GoalsThatLeanAreLeftOutWhereOthersDoNot) {
  const Arm& arm = testing::walled_arm().robot.arm;
  const GoalOptions options{.poses = 40, .max = 4000, .tilt = TiltLimit{.max = 0.2}};
  const auto goals = goals_of({.X_WR = kBehindWall, .lean = 0.6}, options);
  ASSERT_TRUE(goals);
  for (const JointVec& q : *goals) EXPECT_LE(tilt(*options.tilt, arm, as_span(q)), 0.2);
  // All lean: the planner shall say by how much.
  GoalRegion leaning{kBehindWall};
  leaning.X_WR.R = from_euler({pi - 0.5, 0, 0});
  EXPECT_TRUE(goals_of(leaning, options));
}

TEST(GoalRegion, RefusesPosturesOfAnotherSize) {
  const testing::CoveredArm& arm = testing::walled_arm();
  const IkSolver ik(arm.robot.arm);
  for (const std::size_t size : {0u, 5u, 40u}) {
    const std::vector<double> q(size);
    const auto goals = goals_in(arm.checker, ik, {.X_WR = kBehindWall}, q);
    ASSERT_FALSE(goals);
    EXPECT_EQ(goals.error().code, IkErrc::bad_input);
  }
}

TEST(GoalRegion, RefusesTolerancesThatAreNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const GoalRegion& bad :
       {GoalRegion{kBehindWall, {-0.1, 0, 0}}, GoalRegion{kBehindWall, {0, nan, 0}},
        GoalRegion{kBehindWall, {0, 0, 11}}, GoalRegion{kBehindWall, {0, 0, 0}, -0.1},
        GoalRegion{kBehindWall, {0, 0, 0}, 4}, GoalRegion{kBehindWall, {0, 0, 0}, 0, nan},
        GoalRegion{{{nan, 0, 0}, Eigen::Matrix3d::Identity()}, {0.1, 0, 0}}}) {
    const auto goals = goals_of(bad);
    ASSERT_FALSE(goals);
    EXPECT_EQ(goals.error().code, IkErrc::bad_input);
  }
}

}  // namespace
}  // namespace mjarm
