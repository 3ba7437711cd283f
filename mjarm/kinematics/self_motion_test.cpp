#include "mjarm/kinematics/self_motion.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {
namespace {

using testing::panda;
using testing::random_q;
using testing::ur5e;

constexpr PostureGoal kGoals[] = {PostureGoal::near_posture, PostureGoal::away_from_limits,
                                  PostureGoal::manipulability};

/// What a goal lowers, written once more.
double cost(const Arm& arm, const SelfMotionOptions& options, const JointVec& q) {
  if (options.goal == PostureGoal::near_posture) return (q - options.posture).norm();
  if (options.goal == PostureGoal::manipulability) {
    return -manipulability(fk_jacobian(arm, as_span(q)).J_W);
  }
  const JointVec middle = 0.5 * (arm.limits.lower + arm.limits.upper);
  const JointVec half = 0.5 * (arm.limits.upper - arm.limits.lower);
  return (q - middle).cwiseQuotient(half).norm();
}

TEST(SelfMotion, KeepsThePoseAndBettersTheGoal) {
  const Arm arm = panda();
  const IkSolver ik(arm);
  Rng rng(1);
  for (const PostureGoal goal : kGoals) {
    const SelfMotionOptions options{.goal = goal, .posture = arm.home};
    int better = 0;
    for (int i = 0; i < 200; ++i) {
      const JointVec q = random_q(arm, rng);
      const Pose X_goal = fk(arm, as_span(q));
      const auto settled = null_space_step(ik, X_goal, as_span(q), options);
      ASSERT_TRUE(settled.has_value());
      const Pose X = fk(arm, as_span(settled->q));
      EXPECT_LT((X.p - X_goal.p).norm(), 1.01e-7);
      EXPECT_LT(angle_between(X.R, X_goal.R), 1.01e-7);
      EXPECT_TRUE(within_limits(arm, as_span(settled->q)));
      EXPECT_LE(cost(arm, options, settled->q), cost(arm, options, q) + 1e-12);
      if (cost(arm, options, settled->q) < cost(arm, options, q) - 1e-3) ++better;
    }
    EXPECT_GT(better, 140);
  }
}

/// The oracle is brute force: solve() from seeds moved a little along every joint, which gives
/// other configurations of the same self-motion.
TEST(SelfMotion, NothingNearbyIsBetter) {
  const Arm arm = panda();
  const IkSolver ik(arm);
  const IkSolver near(arm, {.restarts = 0, .closed_form = false});
  Rng rng(2);
  for (const PostureGoal goal : kGoals) {
    const SelfMotionOptions options{.goal = goal, .posture = random_q(arm, rng)};
    int compared = 0, beaten = 0;
    for (int i = 0; i < 50; ++i) {
      const JointVec q = random_q(arm, rng);
      const Pose X_goal = fk(arm, as_span(q));
      const auto settled = null_space_step(ik, X_goal, as_span(q), options);
      ASSERT_TRUE(settled.has_value());
      for (int k = 0; k < 14; ++k) {
        JointVec seed = settled->q;
        seed[k / 2] += k % 2 == 0 ? 0.03 : -0.03;
        const auto other = near.solve(X_goal, as_span(seed));
        if (!other || (other->q - settled->q).norm() > 0.1) continue;
        ++compared;
        if (cost(arm, options, other->q) < cost(arm, options, settled->q) - 1e-4) ++beaten;
      }
    }
    EXPECT_GT(compared, 400);
    EXPECT_EQ(beaten, 0) << static_cast<int>(goal);
  }
}

/// A posture of the same self-motion is found from nearby.
TEST(SelfMotion, ReachesAPostureThatTheToolAllows) {
  const Arm arm = panda();
  const IkSolver ik(arm);
  const JointVec posture = joint_vec(std::vector<double>{0.1, -0.5, 0.2, -2.1, 0.1, 1.8, 0.6});
  const Pose X_goal = fk(arm, as_span(posture));
  SelfMotionOptions away{.goal = PostureGoal::near_posture, .posture = posture};
  away.posture[0] += 0.5;
  const auto first = null_space_step(ik, X_goal, as_span(posture), away);
  ASSERT_TRUE(first.has_value());
  EXPECT_GT((first->q - posture).norm(), 0.1);
  const auto back = null_space_step(ik, X_goal, as_span(first->q),
                                    {.goal = PostureGoal::near_posture, .posture = posture});
  ASSERT_TRUE(back.has_value());
  EXPECT_LT((back->q - posture).norm(), 1e-3);
}

TEST(SelfMotion, LeavesASingularity) {
  const Arm arm = panda();
  const JointVec q = joint_vec(std::vector<double>{0.3, 0, 1.5707963267948966, -1.5, 0, 1.5, 0.2});
  ASSERT_LT(manipulability(fk_jacobian(arm, as_span(q)).J_W), 1e-9);
  const auto settled = null_space_step(IkSolver(arm), fk(arm, as_span(q)), as_span(q),
                                       {.goal = PostureGoal::manipulability});
  ASSERT_TRUE(settled.has_value());
  EXPECT_GT(manipulability(fk_jacobian(arm, as_span(settled->q)).J_W), 0.01);
}

TEST(SelfMotion, AnArmWithoutFreedomKeepsItsJoints) {
  const Arm arm = ur5e();
  const IkSolver ik(arm);
  Rng rng(2);
  for (int i = 0; i < 200; ++i) {
    const JointVec q = random_q(arm, rng);
    const auto settled = null_space_step(ik, fk(arm, as_span(q)), as_span(q));
    ASSERT_TRUE(settled.has_value());
    EXPECT_LT((settled->q - q).cwiseAbs().maxCoeff(), 1e-6);
  }
}

/// With less asked of the tool, a six-axis arm has freedom too.
TEST(SelfMotion, SixJointsMoveWithinATaskThatLeavesThemRoom) {
  const Arm arm = ur5e();
  Rng rng(3);
  for (const IkTask task : {IkTask::axis, IkTask::position}) {
    const IkSolver ik(arm, {.task = task});
    double gain = 0;
    for (int i = 0; i < 50; ++i) {
      const JointVec q = random_q(arm, rng);
      const SelfMotionOptions options{.goal = PostureGoal::near_posture, .posture = arm.home};
      const Pose X_goal = fk(arm, as_span(q));
      const auto settled = null_space_step(ik, X_goal, as_span(q), options);
      ASSERT_TRUE(settled.has_value());
      const Pose X = fk(arm, as_span(settled->q));
      EXPECT_LT((X.p - X_goal.p).norm(), 1.01e-7);
      const bool axis = task == IkTask::axis;
      EXPECT_LT(axis ? X.R.col(2).cross(X_goal.R.col(2)).norm() : 0, 1.01e-7);
      gain += cost(arm, options, q) - cost(arm, options, settled->q);
    }
    EXPECT_GT(gain / 50, 0.5);
  }
}

TEST(SelfMotion, ThePredicateAndTheStepBoundAreKept) {
  const Arm arm = panda();
  const JointVec q = arm.home;
  const Pose X_WT = fk(arm, as_span(q));
  SelfMotionOptions goal{.goal = PostureGoal::near_posture, .posture = q};
  goal.posture[0] += 0.6;
  const auto moved_by = [&](const IkOptions& options) {
    const auto settled = null_space_step(IkSolver(arm, options), X_WT, as_span(q), goal);
    return settled ? (settled->q - q).cwiseAbs().maxCoeff() : -1;
  };
  EXPECT_GT(moved_by({}), 0.2);
  EXPECT_GT(moved_by({.max_step = 0.1}), 0.05);
  EXPECT_LE(moved_by({.max_step = 0.1}), 0.1);
  IkOptions options;
  options.valid = [&](std::span<const double> other) { return other[0] < q[0] + 0.1; };
  const auto settled = null_space_step(IkSolver(arm, options), X_WT, as_span(q), goal);
  ASSERT_TRUE(settled.has_value());
  EXPECT_LT(settled->q[0], q[0] + 0.1);
  EXPECT_GT(settled->q[0], q[0]);
  options.valid = [](std::span<const double>) { return false; };
  const auto refused = null_space_step(IkSolver(arm, options), X_WT, as_span(q), goal);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, IkErrc::collision);
}

TEST(SelfMotion, BadInputIsRefused) {
  const Arm arm = panda();
  const IkSolver ik(arm);
  const Pose X = fk(arm, as_span(arm.home));
  const auto refused = [&](const Pose& X_WT, std::span<const double> from,
                           const SelfMotionOptions& options) {
    const auto settled = null_space_step(ik, X_WT, from, options);
    return !settled && settled.error().code == IkErrc::bad_input;
  };
  EXPECT_FALSE(refused(X, as_span(arm.home), {}));
  EXPECT_TRUE(refused(X, {}, {}));
  EXPECT_TRUE(refused({{2, 0, 0}, X.R}, as_span(arm.home), {}));
  EXPECT_TRUE(refused(X, as_span(arm.home), {.goal = PostureGoal::near_posture}));
  EXPECT_TRUE(refused(X, as_span(arm.home), {.max_steps = -1}));
  EXPECT_TRUE(refused(X, as_span(arm.home), {.tolerance = 0}));
  const JointVec nan = JointVec::Constant(7, std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(refused(X, as_span(nan), {}));
  EXPECT_TRUE(refused(X, as_span(arm.home), {.goal = PostureGoal::near_posture, .posture = nan}));
}

}  // namespace
}  // namespace mjarm
