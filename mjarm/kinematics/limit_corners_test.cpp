// Poses that are reached with joints at their limits are reachable like any others.
#include <gtest/gtest.h>

#include <iostream>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"

namespace mjarm {
namespace {

/// About two joints of five exactly at a limit.
JointVec in_a_corner(const Arm& arm, Rng& rng) {
  JointVec q = testing::random_q(arm, rng);
  for (int i = 0; i < arm.dof(); ++i) {
    const double side = rng.uniform();
    if (side < 0.2) q[i] = arm.limits.lower[i];
    if (side > 0.8) q[i] = arm.limits.upper[i];
  }
  return q;
}

class LimitCorners : public ::testing::TestWithParam<int> {};

TEST_P(LimitCorners, EveryPoseOfRandomArmsIsFoundAgain) {
  constexpr int kPosesAnArm = 50;
  const int dof = GetParam();
  const int count = testing::rounds(2500, 20'000, 250);
  Rng rng(static_cast<std::uint64_t>(900 + dof));
  int missed = 0;
  for (int done = 0; done < count;) {
    const Arm arm = testing::random_arm(dof, rng);
    const IkSolver ik(arm);
    for (int i = 0; i < kPosesAnArm && done < count; ++i, ++done) {
      const bool corner = i % 2 == 0;
      const JointVec q = corner ? in_a_corner(arm, rng) : testing::random_q(arm, rng);
      const Pose X_WT = fk(arm, as_span(q));
      const auto answer = ik.solve(X_WT, as_span(testing::random_q(arm, rng)));
      if (!answer) {
        ++missed;
        std::cout << "pose " << done << ": " << describe(answer.error(), arm) << '\n';
        continue;
      }
      const Pose X = fk(arm, as_span(answer->q));
      EXPECT_LT((X.p - X_WT.p).norm(), 1.01e-7);
      EXPECT_LT(angle_between(X.R, X_WT.R), 1.01e-7);
      EXPECT_TRUE(within_limits(arm, as_span(answer->q)));
    }
  }
  EXPECT_EQ(missed, 0) << "of " << count;
}

TEST_P(LimitCorners, WhatIsBeyondALimitIsStillNamed) {
  Rng rng(static_cast<std::uint64_t>(700 + GetParam()));
  int named = 0;
  for (int i = 0; i < 20; ++i) {
    Arm arm = testing::random_arm(GetParam(), rng);
    const JointVec q = testing::random_q(arm, rng);
    const Pose X_WT = fk(arm, as_span(q));
    // The last joint may no longer go where it has to: with few joints nothing takes its place.
    const Eigen::Index last = arm.dof() - 1;
    arm.limits.upper[last] = q[last] - 0.2;
    arm.limits.lower[last] = q[last] - 0.3;
    const auto answer = IkSolver(arm).solve(X_WT, as_span(arm.home));
    if (!answer && answer.error().code == IkErrc::joint_limit) ++named;
    if (answer) {
      EXPECT_TRUE(within_limits(arm, as_span(answer->q)));
    }
  }
  if (GetParam() < 6) {
    EXPECT_GE(named, 15);
  }
}

INSTANTIATE_TEST_SUITE_P(Joints, LimitCorners, ::testing::Values(4, 5, 6, 7, 8));

}  // namespace
}  // namespace mjarm
