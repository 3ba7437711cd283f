#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"

namespace mjarm {
namespace {

using testing::panda;
using testing::random_arm;
using testing::random_q;
using testing::ur5e;

double angle_between_z(const Pose& a, const Pose& b) {
  return std::atan2(a.R.col(2).cross(b.R.col(2)).norm(), a.R.col(2).dot(b.R.col(2)));
}

struct Count {
  int solved = 0;
  int turned = 0;  ///< answers whose tool is turned by more than 0.1 rad against the goal
};

/// Solves for reachable poses whose tool is then turned at random about what the task leaves free,
/// from random seeds, and checks every answer by forward kinematics.
Count count_tasks(const Arm& arm, IkTask task, int rounds, Rng& rng) {
  Count count;
  const IkSolver ik(arm, {.task = task});
  for (int i = 0; i < rounds; ++i) {
    Pose X_goal = fk(arm, as_span(random_q(arm, rng)));
    const double turn = rng.uniform(-3, 3);
    const bool axis = task == IkTask::axis;
    X_goal.R *= from_euler({axis ? 0 : rng.uniform(-3, 3), axis ? 0 : rng.uniform(-3, 3), turn});
    const auto answer = ik.solve(X_goal, as_span(random_q(arm, rng)));
    if (!answer) continue;
    ++count.solved;
    const Pose X = fk(arm, as_span(answer->q));
    EXPECT_LT((X.p - X_goal.p).norm(), 1.01e-7);
    EXPECT_LT(axis ? angle_between_z(X, X_goal) : 0, 1.01e-7);
    EXPECT_NEAR(answer->rot_err, axis ? angle_between_z(X, X_goal) : 0, 1e-9);
    EXPECT_TRUE(within_limits(arm, as_span(answer->q)));
    if (angle_between(X.R, X_goal.R) > 0.1) ++count.turned;
  }
  return count;
}

TEST(IkTask, PositionLeavesTheOrientationFree) {
  Rng rng(40);
  Count count;
  for (int round = 0; round < 300; ++round) {
    const Count one = count_tasks(random_arm(3 + round % 5, rng), IkTask::position, 1, rng);
    count.solved += one.solved;
    count.turned += one.turned;
  }
  EXPECT_GE(count.solved, 297);
  EXPECT_GT(count.turned, 250);
}

TEST(IkTask, AxisLeavesTheTurnAboutItFree) {
  Rng rng(41);
  Count count;
  for (int round = 0; round < 300; ++round) {
    const Count one = count_tasks(random_arm(5 + round % 4, rng), IkTask::axis, 1, rng);
    count.solved += one.solved;
    count.turned += one.turned;
  }
  EXPECT_GE(count.solved, 295);
  EXPECT_GT(count.turned, 250);
}

TEST(IkTask, AxisIsSolvedForTheUr5eAndThePanda) {
  Rng rng(42);
  for (const Arm& arm : {ur5e(), panda()}) {
    const Count count = count_tasks(arm, IkTask::axis, 1000, rng);
    EXPECT_GE(count.solved, 999) << arm.name;
    EXPECT_GT(count.turned, 800) << arm.name;
  }
}

/// Five joints are as many as the task has conditions; for a whole pose they are too few.
TEST(IkTask, FiveJointsAreEnoughForAnAxis) {
  Arm arm = ur5e();
  arm.X_JT = arm.joints[5].X_PJ * arm.X_JT;
  arm.joints.pop_back();
  for (JointVec* const limit : {&arm.limits.lower, &arm.limits.upper, &arm.home}) {
    limit->conservativeResize(5);
  }
  Rng rng(43);
  EXPECT_GE(count_tasks(arm, IkTask::axis, 300, rng).solved, 297);
  Pose X_goal = fk(arm, std::vector<double>{0.3, -1, 1.2, 0.4, 0.9});
  X_goal.R *= from_euler({0, 0, 1});
  EXPECT_TRUE(IkSolver(arm, {.task = IkTask::axis}).solve(X_goal, as_span(arm.home)).has_value());
  EXPECT_FALSE(IkSolver(arm).solve(X_goal, as_span(arm.home)).has_value());
}

/// The opposite direction is a full answer's worth away, though both axes are parallel.
TEST(IkTask, TheOppositeAxisIsNoAnswer) {
  const Arm arm = ur5e();
  const IkSolver ik(arm, {.task = IkTask::axis});
  const std::vector<double> q{0.4, -1.2, 1.5, -0.8, 1.1, 0.2};
  Pose X_goal = fk(arm, q);
  X_goal.R *= from_euler({std::numbers::pi, 0, 0});
  const auto answer = ik.solve(X_goal, q);
  ASSERT_TRUE(answer.has_value());
  EXPECT_LT(angle_between_z(fk(arm, as_span(answer->q)), X_goal), 1.01e-7);
}

TEST(IkTask, FarPositionsAreProvedOutOfReach) {
  const Arm arm = panda();
  for (const IkTask task : {IkTask::position, IkTask::axis}) {
    const IkSolver ik(arm, {.task = task});
    const auto answer = ik.solve({{0.5, 2, 0.3}, Eigen::Matrix3d::Identity()}, as_span(arm.home));
    ASSERT_FALSE(answer.has_value());
    EXPECT_EQ(answer.error().code, IkErrc::out_of_reach);
    EXPECT_GT(answer.error().amount, 0.5);
    EXPECT_LT(answer.error().amount, answer.error().best.pos_err);
  }
}

}  // namespace
}  // namespace mjarm
