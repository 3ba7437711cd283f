#include <gtest/gtest.h>

#include <map>

#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/hard_negatives_test.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"

namespace mjarm {
namespace {

using testing::nothing_found;
using testing::random_q;

int negatives() { return testing::rounds(150, 1000); }

/// Poses near random reachable ones that the solver refuses.
std::vector<std::pair<Pose, IkFailure>> refused_near(const IkSolver& ik, double place, double turn,
                                                     int count, Rng& rng) {
  std::vector<std::pair<Pose, IkFailure>> out;
  while (static_cast<int>(out.size()) < count) {
    const Pose X = testing::moved(fk(ik.arm(), as_span(random_q(ik.arm(), rng))), place, turn, rng);
    const auto answer = ik.solve(X, as_span(random_q(ik.arm(), rng)));
    if (!answer) out.emplace_back(X, answer.error());
  }
  return out;
}

/// The same arm with joints that turn less.
Arm narrow(Arm arm) {
  const double lower[] = {-1.5, -2.5, -2, -2.2, -1.5, -2};
  const double upper[] = {2, 0.3, 2.4, 1.8, 2, 2.5};
  for (int i = 0; i < 6; ++i) {
    arm.limits.lower[i] = lower[i];
    arm.limits.upper[i] = upper[i];
    arm.home[i] = 0.5 * (lower[i] + upper[i]);
  }
  return arm;
}

TEST(SixAxisHard, WhatIsRefusedCannotBeFound) {
  Rng rng(101);
  std::map<IkErrc, int> reasons;
  for (const Arm& arm : {testing::ur5e(), narrow(testing::ur5e())}) {
    const IkSolver ik(arm);
    for (const auto& [X_WT, failure] : refused_near(ik, 0.15, 0.4, negatives(), rng)) {
      ++reasons[failure.code];
      EXPECT_TRUE(nothing_found(ik, X_WT)) << describe(failure, arm);
      EXPECT_NE(failure.code, IkErrc::no_convergence);
      EXPECT_GT(failure.amount, 0);
      EXPECT_TRUE(within_limits(arm, as_span(failure.best.q)));
      const Pose X = fk(arm, as_span(failure.best.q));
      EXPECT_NEAR((X.p - X_WT.p).norm(), failure.best.pos_err, 1e-9);
      EXPECT_FALSE(describe(failure, arm).empty());
    }
  }
  EXPECT_GT(reasons[IkErrc::out_of_reach], 10);
  EXPECT_GT(reasons[IkErrc::inner_void], 10);
  EXPECT_GT(reasons[IkErrc::joint_limit], 50);
}

/// The tool in its place, turned so that the wrist centre comes to lie beyond the stretched arm.
TEST(SixAxisHard, TheWrongWayRoundAtTheRim) {
  const Arm arm = testing::ur5e();
  const IkSolver ik(arm);
  Rng rng(102);
  int told = 0;
  while (told < negatives()) {
    JointVec q = random_q(arm, rng);
    q[2] = rng.uniform(-0.2, 0.2);
    const Pose X = testing::moved(fk(arm, as_span(q)), 0, 1, rng);
    const auto answer = ik.solve(X, as_span(arm.home));
    if (answer) continue;
    ++told;
    EXPECT_TRUE(answer.error().code == IkErrc::out_of_reach ||
                answer.error().code == IkErrc::inner_void);
    EXPECT_TRUE(nothing_found(ik, X)) << describe(answer.error(), arm);
  }
}

TEST(SixAxisHard, InsideTheCylinder) {
  const Arm arm = testing::ur5e();
  const IkSolver ik(arm);
  Rng rng(103);
  for (int i = 0; i < negatives(); ++i) {
    const double r = rng.uniform(0, 0.1339), around = rng.uniform(-3.2, 3.2);
    Pose X;
    X.R = rotation_exp(2 * testing::normal_vector(rng));
    // The wrist centre lies 0.1 m behind the tool.
    X.p = Eigen::Vector3d(r * std::cos(around), r * std::sin(around), rng.uniform(-0.4, 0.9)) +
          0.1 * X.R.col(2);
    const auto answer = ik.solve(X, as_span(random_q(arm, rng)));
    ASSERT_FALSE(answer.has_value());
    EXPECT_EQ(answer.error().code, IkErrc::inner_void);
    EXPECT_EQ(answer.error().shape, ReachShape::cylinder);
    EXPECT_NEAR(answer.error().amount, 0.134 - r, 1e-8);
    EXPECT_TRUE(nothing_found(ik, X));
  }
}

/// The named joint is the one, and the amount is what is missing.
TEST(SixAxisHard, TheLimitThatIsNamedIsTheOne) {
  const Arm arm = narrow(testing::ur5e());
  const IkSolver ik(arm);
  Rng rng(104);
  int told = 0;
  while (told < negatives()) {
    JointVec q = random_q(arm, rng);
    const auto joint = static_cast<Eigen::Index>(rng.below(6));
    q[joint] = arm.limits.upper[joint] + rng.uniform(0.01, 0.4);
    const Pose X = fk(arm, as_span(q));
    const auto answer = ik.solve(X, as_span(arm.home));
    if (answer) continue;
    ++told;
    const IkFailure& failure = answer.error();
    ASSERT_EQ(failure.code, IkErrc::joint_limit);
    EXPECT_LE(failure.amount, q[joint] - arm.limits.upper[joint] + 1e-6);
    EXPECT_TRUE(nothing_found(ik, X));
    // Every limit wider by the amount: just enough; by a little less: not.
    const auto widened = [&](double by) {
      Arm other = arm;
      other.limits.lower.array() -= by;
      other.limits.upper.array() += by;
      return IkSolver(other).solve(X, as_span(arm.home)).has_value();
    };
    EXPECT_TRUE(widened(failure.amount + 1e-7));
    EXPECT_FALSE(widened(failure.amount - 1e-5));
  }
}

}  // namespace
}  // namespace mjarm
