#include "mjarm/planning/joint_barrier.hpp"

#include <gtest/gtest.h>

#include "mjarm/collision/exact.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/planning/planning_world.hpp"

namespace mjarm {
namespace {

/// The UR5e above its floor.
struct BarrierWorld {
  Robot robot = load_robot("ur5e").value();
  PlanningWorld world = PlanningWorld::create(robot).value();
  const WorldScene& scene = *world.scene().value();
  BallScene balls = ball_scene(scene.checker, scene.cover.scene);
};

TEST(JointBarrier, IsWhereNoConfigurationIsFree) {
  const BarrierWorld ur5e;
  const Arm& arm = ur5e.robot.arm;
  JointVec goal = arm.home;
  goal[1] += 6.2;
  const auto barrier = find_barrier(arm, ur5e.balls, as_span(arm.home), std::vector{goal});
  ASSERT_TRUE(barrier);
  EXPECT_EQ(barrier->joint, 1);
  EXPECT_GT(barrier->at, arm.home[1]);
  EXPECT_LT(barrier->at, goal[1]);
  const ExactChecker exact(ur5e.robot.model, ur5e.robot.arm);
  const auto is_free = exact.predicate();
  Rng rng(5);
  for (int k = 0; k < 2000; ++k) {
    JointVec q(arm.dof());
    for (int i = 0; i < arm.dof(); ++i)
      q[i] = rng.uniform(arm.limits.lower[i], arm.limits.upper[i]);
    q[1] = barrier->at;
    EXPECT_FALSE(is_free(as_span(q))) << k;
  }
}

TEST(JointBarrier, StandsBeforeEveryGoalOrIsNone) {
  const BarrierWorld ur5e;
  const Arm& arm = ur5e.robot.arm;
  JointVec beyond = arm.home, near = arm.home;
  beyond[1] += 6.2;
  near[1] += 0.5;
  near[0] += 6;
  EXPECT_TRUE(find_barrier(arm, ur5e.balls, as_span(arm.home), std::vector{beyond, beyond}));
  EXPECT_FALSE(find_barrier(arm, ur5e.balls, as_span(arm.home), std::vector{near}));
  EXPECT_FALSE(find_barrier(arm, ur5e.balls, as_span(arm.home), std::vector{beyond, near}));
}

/// Between goals that a path was found to there is none.
TEST(JointBarrier, IsNotWhereAPathIs) {
  BarrierWorld ur5e;
  const Arm& arm = ur5e.robot.arm;
  Rng rng(6);
  int paths = 0;
  for (int k = 0; k < 60; ++k) {
    JointVec goal(arm.dof());
    for (int i = 0; i < arm.dof(); ++i) {
      goal[i] = rng.uniform(arm.limits.lower[i], arm.limits.upper[i]);
    }
    if (!ur5e.scene.checker.is_free(as_span(goal))) continue;
    const std::vector<JointVec> goals{goal};
    const bool found =
        ur5e.world.plan(as_span(arm.home), goals, {.samples = 3000, .clearance = 0.0}).has_value();
    const bool barred = find_barrier(arm, ur5e.balls, as_span(arm.home), goals).has_value();
    EXPECT_FALSE(found && barred) << k;
    paths += found ? 1 : 0;
  }
  EXPECT_GE(paths, 5);
}

}  // namespace
}  // namespace mjarm
