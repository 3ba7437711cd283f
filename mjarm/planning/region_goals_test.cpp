#include "mjarm/planning/region_goals.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/planning/covered_arm_test.hpp"

namespace mjarm {
namespace {

using std::numbers::pi;

const Pose kBehindWall{{-0.3, -0.45, 0.2}, from_euler({pi, 0, 0})};

const JointVec& near() { return testing::walled_arm().robot.arm.home; }

Result<RegionGoals, IkFailure> draw(const std::vector<TaskRegion>& regions,
                                    const RegionGoalOptions& options = {}) {
  const testing::CoveredArm& arm = testing::walled_arm();
  return RegionGoals::create(arm.checker, IkSolver(arm.robot.arm), regions, as_span(near()),
                             options);
}

Result<std::vector<JointVec>, IkFailure> goals_of(const TaskRegion& region,
                                                  const RegionGoalOptions& options = {}) {
  return draw({region}, options).map([](const RegionGoals& goals) { return goals.q(); });
}

Pose tool(const JointVec& q) { return fk(testing::walled_arm().robot.arm, as_span(q)); }

TEST(RegionGoals, APoseIsAllItsBranchesThatAreFreeNearestFirst) {
  const auto goals = goals_of(region_about(kBehindWall));
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
  const auto few = goals_of(region_about(kBehindWall), {.max = 3});
  ASSERT_TRUE(few);
  ASSERT_EQ(few->size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ((*few)[k], (*goals)[k]);
}

TEST(RegionGoals, ReachesWhereItsMiddleCannotBeReached) {
  const Pose far{{-0.95, -0.3, 0.2}, from_euler({pi, 0, 0})};
  const auto none = goals_of(region_about(far));
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, IkErrc::out_of_reach);
  EXPECT_TRUE(goals_of(region_about(far, {0.4, 0, 0})));
}

TEST(RegionGoals, GraspsOfACanFromAnySide) {
  // The tool level, 12 cm from the axis of a can, pointing at it.
  TaskRegion region{.X_WR = {{-0.45, -0.35, 0.25}, Eigen::Matrix3d::Identity()},
                    .X_FT = {{-0.12, 0, 0}, from_euler({0, pi / 2, 0})}};
  region.turn_min[2] = -kFreeTurn;
  region.turn_max[2] = kFreeTurn;
  auto goals = draw({region}, {.max = 4000});
  ASSERT_TRUE(goals);
  std::set<int> sides;
  for (const JointVec& q : goals->q()) {
    const Eigen::Vector3d to_can = region.X_WR.p - tool(q).p;
    EXPECT_NEAR(to_can.norm(), 0.12, 1e-6);
    EXPECT_NEAR(to_can.normalized().dot(tool(q).R.col(2)), 1, 1e-9);
    EXPECT_NEAR(to_can[2], 0, 1e-6);
    sides.insert(static_cast<int>(std::floor(std::atan2(to_can[1], to_can[0]) / (pi / 4))));
  }
  const std::size_t few = sides.size();
  EXPECT_GE(few, 3u);
  ASSERT_TRUE(goals->draw_more());
  EXPECT_GT(goals->q().size(), 64u);
}

TEST(RegionGoals, SeveralAtOnceSayWhichAndMoreAreAlwaysTheSame) {
  const TaskRegion here = region_about(kBehindWall, {0.05, 0.05, 0.02});
  const TaskRegion there = region_about({{0.3, -0.45, 0.3}, kBehindWall.R}, {0.05, 0, 0}, 0.2);
  auto goals = draw({here, there});
  ASSERT_TRUE(goals);
  const auto check = [&] {
    std::array<int, 2> count{};
    for (int g = 0; g < static_cast<int>(goals->q().size()); ++g) {
      const int region = goals->region_of(g);
      ++count[static_cast<std::size_t>(region)];
      const Pose X_WT = tool(goals->q()[static_cast<std::size_t>(g)]);
      EXPECT_TRUE(room_in(region == 0 ? here : there, X_WT).within(1e-6));
      EXPECT_FALSE(room_in(region == 0 ? there : here, X_WT).within());
    }
    return count;
  };
  const auto first = check();
  EXPECT_GT(first[0] + first[1], 32);
  ASSERT_TRUE(goals->draw_more());
  const auto second = check();
  EXPECT_EQ(second[0] + second[1], 128);
  auto again = draw({here, there});
  ASSERT_TRUE(again->draw_more());
  EXPECT_EQ(again->q(), goals->q());
  EXPECT_FALSE(draw({region_about(kBehindWall)})->draw_more()) << "a pose has no more";
}

TEST(RegionGoals, WhereAllCollidesTheyAreGivenSoThatThePlannerSaysWithWhat) {
  const testing::CoveredArm& arm = testing::walled_arm();
  const Pose inside{{0, -0.45, 0.2}, from_euler({pi, 0, 0})};
  const auto goals = goals_of(region_about(inside));
  ASSERT_TRUE(goals);
  for (const JointVec& q : *goals) EXPECT_FALSE(arm.checker.is_free(as_span(q)));
  const auto path = plan_path(arm.checker, as_span(near()), std::span(*goals).first(1));
  ASSERT_FALSE(path);
  EXPECT_EQ(path.error().code, PlanErrc::goals_hit);
}

TEST(RegionGoals, GoalsThatAreNotKeptAreLeftOutWhereOthersAre) {
  const Arm& arm = testing::walled_arm().robot.arm;
  const TaskRegion low = region_about(kBehindWall, {1, 1, 0.01}, 0.2, pi);
  const RegionGoalOptions options{
      .poses = 40, .max = 4000, .tilt = TiltLimit{.max = 0.2}, .within = low};
  const auto goals = goals_of(region_about(kBehindWall, {0, 0, 0.02}, 0.6), options);
  ASSERT_TRUE(goals);
  for (const JointVec& q : *goals) {
    EXPECT_LE(tilt(*options.tilt, arm, as_span(q)), 0.2);
    EXPECT_TRUE(room_in(low, tool(q)).within());
  }
  // All lean: the planner shall say by how much.
  EXPECT_TRUE(goals_of(region_about({kBehindWall.p, from_euler({pi - 0.5, 0, 0})}), options));
}

TEST(RegionGoals, RefusesPosturesOfAnotherSize) {
  const testing::CoveredArm& arm = testing::walled_arm();
  const std::vector<TaskRegion> regions{region_about(kBehindWall)};
  for (const std::size_t size : {0u, 5u}) {
    const std::vector<double> q(size);
    const auto goals = RegionGoals::create(arm.checker, IkSolver(arm.robot.arm), regions, q);
    ASSERT_FALSE(goals);
    EXPECT_EQ(goals.error().code, IkErrc::bad_input);
  }
  TaskRegion bad = region_about(kBehindWall);
  bad.place_min[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(draw({bad}).error().code, IkErrc::bad_input);
  EXPECT_EQ(draw({}).error().code, IkErrc::bad_input);
}

}  // namespace
}  // namespace mjarm
