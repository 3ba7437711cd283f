#include "mjarm/kinematics/ik_all.hpp"

#include <gtest/gtest.h>

#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {
namespace {

using testing::panda;
using testing::random_q;
using testing::ur5e;

double distance(const JointVec& a, const JointVec& b) { return (a - b).cwiseAbs().maxCoeff(); }

void expect_sound(const Arm& arm, const Pose& X_goal, const JointVec& seed,
                  const std::vector<IkSolution>& answers) {
  ASSERT_FALSE(answers.empty());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const Pose X = fk(arm, as_span(answers[i].q));
    EXPECT_LT((X.p - X_goal.p).norm(), 1.01e-7);
    EXPECT_LT(angle_between(X.R, X_goal.R), 1.01e-7);
    EXPECT_TRUE(within_limits(arm, as_span(answers[i].q)));
    if (i > 0) {
      EXPECT_LE(distance(answers[i - 1].q, seed), distance(answers[i].q, seed));
    }
    for (std::size_t k = 0; k < i; ++k) EXPECT_GE(distance(answers[i].q, answers[k].q), 1e-3);
  }
}

/// An arm of this class has at most eight branches: shoulder, elbow and wrist, two ways each.
TEST(IkAll, FindsTheBranchesOfTheUr5e) {
  const Arm arm = ur5e();
  const IkSolver ik(arm);
  Rng rng(51);
  int of_eight = 0;
  for (int i = 0; i < 200; ++i) {
    const JointVec q = random_q(arm, rng);
    const JointVec seed = random_q(arm, rng);
    const Pose X_goal = fk(arm, as_span(q));
    const auto answers = solve_all(ik, X_goal, as_span(seed));
    ASSERT_TRUE(answers.has_value());
    expect_sound(arm, X_goal, seed, *answers);
    EXPECT_LE(answers->size(), 8U);
    of_eight += answers->size() == 8 ? 1 : 0;
  }
  EXPECT_GT(of_eight, 80);
}

TEST(IkAll, SamplesARedundantArm) {
  const Arm arm = panda();
  Rng rng(52);
  for (int i = 0; i < 50; ++i) {
    const JointVec seed = random_q(arm, rng);
    const Pose X_goal = fk(arm, as_span(random_q(arm, rng)));
    const auto answers = solve_all(IkSolver(arm), X_goal, as_span(seed), {.starts = 30});
    ASSERT_TRUE(answers.has_value());
    expect_sound(arm, X_goal, seed, *answers);
  }
}

TEST(IkAll, SameInputsSameAnswers) {
  const Arm arm = ur5e();
  Rng rng(53);
  const Pose X_goal = fk(arm, as_span(random_q(arm, rng)));
  const JointVec seed = random_q(arm, rng);
  const auto a = solve_all(IkSolver(arm), X_goal, as_span(seed));
  const auto b = solve_all(IkSolver(arm), X_goal, as_span(seed));
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->size(), b->size());
  for (std::size_t i = 0; i < a->size(); ++i) EXPECT_EQ((*a)[i].q, (*b)[i].q);
}

TEST(IkAll, PredicateAndReasonsHold) {
  const Arm arm = ur5e();
  IkOptions options;
  options.valid = [](std::span<const double> q) { return q[2] < 0; };
  const JointVec q = joint_vec(std::vector<double>{0.3, -1.1, 1.3, 0.5, 1.2, 0.2});
  const auto answers = solve_all(IkSolver(arm, options), fk(arm, as_span(q)), as_span(q));
  ASSERT_TRUE(answers.has_value());
  for (const IkSolution& answer : *answers) EXPECT_LT(answer.q[2], 0);
  const auto none = solve_all(IkSolver(arm), {{3, 0, 0}, Eigen::Matrix3d::Identity()}, as_span(q));
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, IkErrc::out_of_reach);
  const auto bad = solve_all(IkSolver(arm), fk(arm, as_span(q)), {});
  ASSERT_FALSE(bad.has_value());
  EXPECT_EQ(bad.error().code, IkErrc::bad_input);
}

}  // namespace
}  // namespace mjarm
