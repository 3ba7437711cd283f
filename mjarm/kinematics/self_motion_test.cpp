#include "mjarm/kinematics/self_motion.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {
namespace {

using testing::panda;
using testing::random_q;

/// The cost that a goal lowers, written once more.
double cost(const Arm& arm, const SelfMotionOptions& options, const JointVec& q) {
  if (options.goal == PostureGoal::near_posture) return (q - options.posture).norm();
  if (options.goal == PostureGoal::manipulability) {
    return -manipulability(fk_jacobian(arm, view(q)).J_W);
  }
  const JointVec middle = 0.5 * (arm.limits.lower + arm.limits.upper);
  const JointVec half = 0.5 * (arm.limits.upper - arm.limits.lower);
  return (q - middle).cwiseQuotient(half).norm();
}

TEST(SelfMotion, KeepsThePoseAndBettersTheGoal) {
  const Arm arm = panda();
  const IkSolver ik(arm);
  Rng rng(1);
  for (const PostureGoal goal :
       {PostureGoal::near_posture, PostureGoal::away_from_limits, PostureGoal::manipulability}) {
    int better = 0;
    for (int i = 0; i < 100; ++i) {
      const SelfMotionOptions options{.goal = goal, .posture = arm.home};
      const JointVec q = random_q(arm, rng);
      const Pose X_goal = fk(arm, view(q));
      const auto settled = settle(ik, X_goal, view(q), options);
      ASSERT_TRUE(settled.has_value());
      const Pose X = fk(arm, view(settled->q));
      EXPECT_LT((X.p - X_goal.p).norm(), 1.01e-7);
      EXPECT_LT(angle_between(X.R, X_goal.R), 1.01e-7);
      EXPECT_TRUE(within_limits(arm, view(settled->q)));
      EXPECT_LE(cost(arm, options, settled->q), cost(arm, options, q) + 1e-12);
      if (cost(arm, options, settled->q) < cost(arm, options, q) - 1e-3) ++better;
    }
    EXPECT_GT(better, 70);
  }
}

/// A posture of the same self-motion is found from nearby.
TEST(SelfMotion, ReachesAPostureThatTheToolAllows) {
  const Arm arm = panda();
  const IkSolver ik(arm);
  const JointVec posture = joint_vec(std::vector<double>{0.1, -0.5, 0.2, -2.1, 0.1, 1.8, 0.6});
  const Pose X_goal = fk(arm, view(posture));
  const SelfMotionOptions away{.goal = PostureGoal::near_posture,
                               .posture = posture + JointVec::Constant(7, 0.4)};
  const auto first = settle(ik, X_goal, view(posture), away);
  ASSERT_TRUE(first.has_value());
  EXPECT_GT((first->q - posture).norm(), 0.1);
  const auto back =
      settle(ik, X_goal, view(first->q), {.goal = PostureGoal::near_posture, .posture = posture});
  ASSERT_TRUE(back.has_value());
  EXPECT_LT((back->q - posture).norm(), 1e-3);
}

TEST(SelfMotion, AnArmWithoutFreedomKeepsItsJoints) {
  const Arm arm = testing::ur5e();
  const IkSolver ik(arm);
  Rng rng(2);
  for (int i = 0; i < 50; ++i) {
    const JointVec q = random_q(arm, rng);
    const auto settled = settle(ik, fk(arm, view(q)), view(q));
    ASSERT_TRUE(settled.has_value());
    EXPECT_LT((settled->q - q).cwiseAbs().maxCoeff(), 0.05);
  }
}

TEST(SelfMotion, ThePredicateIsKept) {
  const Arm arm = panda();
  const JointVec q = arm.home;
  IkOptions options;
  options.valid = [&](std::span<const double> other) { return other[0] == q[0]; };
  const auto settled = settle(IkSolver(arm, options), fk(arm, view(q)), view(q),
                              {.goal = PostureGoal::manipulability});
  ASSERT_TRUE(settled.has_value());
  EXPECT_EQ(settled->q[0], q[0]);
}

TEST(SelfMotion, BadInputIsRefused) {
  const Arm arm = panda();
  const IkSolver ik(arm);
  const Pose X = fk(arm, view(arm.home));
  const auto refused = [&](const Pose& X_WT, std::span<const double> from,
                           const SelfMotionOptions& options) {
    const auto settled = settle(ik, X_WT, from, options);
    return !settled && settled.error().code == IkErrc::bad_input;
  };
  EXPECT_FALSE(refused(X, view(arm.home), {}));
  EXPECT_TRUE(refused(X, {}, {}));
  EXPECT_TRUE(refused({{2, 0, 0}, X.R}, view(arm.home), {}));
  EXPECT_TRUE(refused(X, view(arm.home), {.goal = PostureGoal::near_posture}));
  EXPECT_TRUE(refused(X, view(arm.home), {.max_steps = -1}));
  EXPECT_TRUE(refused(X, view(arm.home), {.tolerance = 0}));
  const JointVec nan = JointVec::Constant(7, std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(refused(X, view(nan), {}));
  EXPECT_TRUE(refused(X, view(arm.home), {.goal = PostureGoal::near_posture, .posture = nan}));
}

}  // namespace
}  // namespace mjarm
