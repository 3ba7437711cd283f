#include "mjarm/planning/tilt_limit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/planning/covered_arm_test.hpp"
#include "mjarm/planning/goals_test.hpp"
#include "mjarm/planning/ompl_planners.hpp"
#include "mjarm/planning/region_goals.hpp"

namespace mjarm {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Pose tool_down(const Eigen::Vector3d& p, double turn = 0) {
  return {p, from_euler({std::numbers::pi, 0, turn})};
}

/// The first answer that is free, with the tool pointing down.
JointVec nearest_answer(const testing::CoveredArm& arm, const Pose& X_WT, const JointVec& q) {
  const std::vector<TaskRegion> regions{region_about(X_WT)};
  return RegionGoals::create(arm.checker, IkSolver(arm.robot.arm), regions, as_span(q))
      ->q()
      .front();
}

JointVec free_answer(const testing::CoveredArm& arm, const Pose& X_WT) {
  return nearest_answer(arm, X_WT, arm.robot.arm.home);
}

TEST(TiltLimit, KeepsUpWhatIsUp) {
  const Arm arm = testing::ur5e();
  Rng rng(3);
  for (int k = 0; k < 50; ++k) {
    JointVec q(arm.dof());
    for (double& x : q) x = rng.uniform(-3, 3);
    const TiltLimit limit = keep_upright(arm, as_span(q), 0.1);
    EXPECT_NEAR(tilt(limit, arm, as_span(q)), 0, 1e-12);
    q[0] += rng.uniform(-2, 2);  // about the vertical
    EXPECT_NEAR(tilt(limit, arm, as_span(q)), 0, 1e-7);
    // A turn about a level axis by less than a right angle tilts by as much.
    const double turn = rng.uniform(-1.5, 1.5);
    q[1] += turn;
    EXPECT_NEAR(tilt(limit, arm, as_span(q)), std::abs(turn), 1e-6);
  }
}

TEST(TiltLimit, IsARegionWhoseLeanAloneIsBounded) {
  const Arm arm = testing::ur5e();
  Rng rng(4);
  for (int k = 0; k < 50; ++k) {
    JointVec q(arm.dof());
    for (double& x : q) x = rng.uniform(-3, 3);
    const Eigen::Vector3d axis_T(rng.normal(), rng.normal(), rng.normal());
    const TiltLimit limit{.max = 0.3, .axis_T = axis_T.normalized()};
    const RegionRoom room = room_in(as_region(limit), fk(arm, as_span(q)));
    EXPECT_NEAR(room.turn, 0.3 - tilt(limit, arm, as_span(q)), 1e-7);
    EXPECT_EQ(room.place, kFreePlace);
  }
}

TEST(TiltPlan, CarriesTheToolUprightRoundTheWall) {
  const testing::CoveredArm& arm = testing::walled_arm();
  const JointVec start = free_answer(arm, tool_down({0.3, -0.45, 0.2}));
  PlanOptions options;
  // Alone, as others may be reached by the base joint, on the far side of the wall.
  const JointVec goal = nearest_answer(arm, tool_down({-0.3, -0.45, 0.2}), start);
  const auto plain =
      plan_path(arm.checker, as_span(start), testing::goal_at(as_span(goal)), options);
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->tilt, 0);
  // Without a limit it leans; how far is another path's on another processor.
  EXPECT_GT(testing::expect_free_exactly(arm, *plain, TiltLimit{.max = 5 * kDegree}), 5 * kDegree);
  for (const double max : {20 * kDegree, 5 * kDegree, 1 * kDegree}) {
    options.tilt = TiltLimit{.max = max};
    ASSERT_LT(tilt(*options.tilt, arm.robot.arm, as_span(start)), 1e-5);
    for (const Planner planner : {Planner::rrt_connect, Planner::rrt_star}) {
      options.planner = planner;
      options.samples = planner == Planner::rrt_star ? 2000 : 0;
      const auto path =
          plan_path(arm.checker, as_span(start), testing::goal_at(as_span(goal)), options);
      ASSERT_TRUE(path) << describe(path.error(), arm.checker.robot(), arm.cover.scene);
      const double largest = testing::expect_free_exactly(arm, *path, options.tilt);
      EXPECT_LE(largest, path->tilt + 1e-9);
      EXPECT_LE(path->tilt, max * (1 + 1e-7));
      EXPECT_LT(path->cost, 3 * plain->cost);
    }
  }
}

TEST(TiltPlan, SameBytesEveryTimeAndShorterWithRounds) {
  const testing::CoveredArm& arm = testing::walled_arm();
  const JointVec start = free_answer(arm, tool_down({0.3, -0.45, 0.2}));
  const JointVec goal = free_answer(arm, tool_down({-0.3, -0.45, 0.2}));
  PlanOptions options{.tilt = TiltLimit{.max = 10 * kDegree}};
  const auto a = plan_path(arm.checker, as_span(start), testing::goal_at(as_span(goal)), options);
  const auto b = plan_path(arm.checker, as_span(start), testing::goal_at(as_span(goal)), options);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->q, b->q);
  options.rounds = 6;
  const auto better =
      plan_path(arm.checker, as_span(start), testing::goal_at(as_span(goal)), options);
  ASSERT_TRUE(better);
  EXPECT_LE(better->cost, a->cost);
  EXPECT_LE(testing::expect_free_exactly(arm, *better, options.tilt), 10 * kDegree);
}

TEST(TiltPlan, SaysWhoLeansAndRefusesLimitsThatAreNone) {
  const LanguageScope english(Language::english);
  const testing::CoveredArm& arm = testing::walled_arm();
  const JointVec start = free_answer(arm, tool_down({0.3, -0.45, 0.2}));
  JointVec leaning = start;
  leaning[3] += 0.2;
  ASSERT_TRUE(arm.checker.is_free(as_span(leaning)));
  const PlanOptions options{.tilt = TiltLimit{.max = 0.1}};
  const auto why = [&](const JointVec& from, const JointVec& to, const PlanOptions& how) {
    const auto path = plan_path(arm.checker, as_span(from), testing::goal_at(as_span(to)), how);
    return path ? "" : describe(path.error(), arm.checker.robot(), arm.cover.scene);
  };
  EXPECT_EQ(why(leaning, start, options),
            "the tool leans by 0.2 rad at the start, at most 0.1 allowed");
  EXPECT_EQ(why(start, leaning, options),
            "the tool leans too far at every goal: by 0.2 rad, at most 0.1 allowed");
  for (const double max : {0.0, -1.0, 1.6, std::nan(""), 1e-4}) {
    EXPECT_NE(why(start, start, {.tilt = TiltLimit{.max = max}}).find("expected a tilt"),
              std::string::npos);
  }
  PlanOptions ompl = options;
  ompl.planner = Planner::ompl;
  const bool built_in = !ompl_version().empty();
  EXPECT_NE(why(start, start, ompl).find(built_in ? "upright" : "libompl-dev"), std::string::npos);
  const TiltLimit longer{.max = 0.1, .axis_T = {0, 0, 2}};
  EXPECT_NE(why(start, start, {.tilt = longer}).find("length 1"), std::string::npos);
}

}  // namespace
}  // namespace mjarm
