#include "mjarm/planning/tilt_limit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/planning/covered_arm_test.hpp"
#include "mjarm/planning/goal_region.hpp"
#include "mjarm/planning/goals_test.hpp"
#include "mjarm/planning/ompl_planners.hpp"
#include "mjarm/planning/tilt_keeper_internal.hpp"

namespace mjarm {
namespace {

using detail::TiltKeeper;

constexpr double kDegree = std::numbers::pi / 180;

Pose tool_down(const Eigen::Vector3d& p, double turn = 0) {
  return {p, from_euler({std::numbers::pi, 0, turn})};
}

/// The first answer that is free, with the tool pointing down.
JointVec nearest_answer(const testing::CoveredArm& arm, const Pose& X_WT, const JointVec& q) {
  return goals_in(arm.checker, IkSolver(arm.robot.arm), {.X_WR = X_WT}, as_span(q)).value().front();
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

TEST(TiltKeeper, EdgesThatAreKeptAreSoAtEveryPlaceAndOthersAreNotAtTheirs) {
  Rng rng(5);
  int kept = 0, left = 0;
  for (int k = 0; k < 1500; ++k) {
    const Arm arm = testing::random_arm(2 + static_cast<int>(rng.below(6)), rng);
    JointVec q0(arm.dof()), q1(arm.dof());
    const double way = rng.uniform(0.05, 1.5);
    for (int i = 0; i < arm.dof(); ++i) {
      q0[i] = rng.uniform(-2, 2);
      q1[i] = q0[i] + rng.uniform(-way, way);
    }
    TiltLimit limit = keep_upright(arm, as_span(q0), rng.uniform(0.02, 1.5));
    if (rng.uniform() < 0.5) {  // some other directions, near to each other
      const Eigen::Vector3d axis = Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal());
      limit.axis_T = (limit.axis_T + 0.3 * limit.max * axis).normalized();
    }
    const TiltKeeper keeper(limit, arm);
    const TiltKeeper::EdgeTilt edge = keeper.look(as_span(q0), as_span(q1));
    double largest = 0;
    for (int i = 0; i <= 200; ++i) {
      const JointVec q = q0 + (q1 - q0) * i / 200.0;
      largest = std::max(largest, tilt(limit, arm, as_span(q)));
    }
    if (edge.kept) {
      ++kept;
      EXPECT_LE(largest, limit.max * (1 + 1e-7));
      EXPECT_LE(largest, edge.largest + 1e-9);
    } else {
      ++left;
      // Within 1e-4 rad of where it was given up the limit is met or crossed.
      const JointVec q = q0 + (q1 - q0) * edge.t;
      EXPECT_GT(tilt(limit, arm, as_span(q)), limit.max - 1e-3);
    }
  }
  EXPECT_GT(kept, 300);
  EXPECT_GT(left, 300);
}

TEST(TiltKeeper, EdgesWithoutEndAreGivenUp) {
  const Arm arm = testing::ur5e();
  const JointVec q0 = JointVec::Zero(6);
  const TiltKeeper keeper(keep_upright(arm, as_span(q0), 0.1), arm);
  JointVec q1 = q0;
  q1[3] = 1e12;
  EXPECT_FALSE(keeper.look(as_span(q0), as_span(q1)).kept);
  q1 = q0;
  q1[0] = 1e17;  // about the vertical: nothing to look at
  EXPECT_TRUE(keeper.look(as_span(q0), as_span(q1)).kept);
}

TEST(TiltKeeper, PutsBackWithinTheLimitOrSaysThatItCannot) {
  const Arm arm = testing::ur5e();
  Rng rng(7);
  const TiltLimit limit{.max = 0.1};
  const TiltKeeper keeper(limit, arm);
  int done = 0;
  for (int k = 0; k < 300; ++k) {
    JointVec q(arm.dof());
    for (double& x : q) x = rng.uniform(-3, 3);
    const JointVec before = q;
    if (!keeper.project({q.data(), 6})) continue;
    ++done;
    EXPECT_LE(tilt(limit, arm, as_span(q)), 0.031);
    EXPECT_TRUE(keeper.keeps(as_span(q)));
    EXPECT_EQ(tilt(limit, arm, as_span(before)) <= 0.03, before == q);
  }
  EXPECT_GT(done, 250);
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
      // The path without a limit does lean.
      EXPECT_GT(testing::expect_free_exactly(arm, *plain, options.tilt), max);
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
