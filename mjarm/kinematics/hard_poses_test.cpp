// Poses at which solvers lose an arm: joints at their limits, joints at zero, where arms are
// stretched and wrists are straight. Each is reached by the joint values it was made from, so that
// none may be refused.
#include <gtest/gtest.h>

#include <functional>
#include <iostream>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"
#include "tests/support/constants.hpp"

namespace mjarm {
namespace {

using Eigen::Vector3d;

using support::kPi;

/// ARX L5, whose file rounds half turns at the sixth digit: its axes 2 to 4 are nearly parallel.
Arm nearly_parallel() {
  const Vector3d half_turn(kPi - 7.346e-6, 0, 0);
  return testing::make_arm("nearly parallel",
                           {{{0, 0, 0.0565}, {0, 0, 0}, {0, 0, 1}, -3.14, 3.14},
                            {{0.02, 0, 0.047}, {0, 0, 0}, {0, 1, 0}, 0, 3.14},
                            {{-0.264, 0, 0}, half_turn, {0, 1, 0}, 0, 3.14},
                            {{0.245, -5e-5, -0.06}, {0, 0, 0}, {0, 1, 0}, -1.7, 1.7},
                            {{0.073914, 5e-5, -0.083391}, {0, 0, 0}, {0, 0, 1}, -1.7, 1.7},
                            {{0.025286, 0, 0.083391}, half_turn, {1, 0, 0}, -3.14, 3.14}},
                           {{0.1, 0, 0}, Eigen::Matrix3d::Identity()});
}

/// KUKA LBR iiwa 14, which is stretched along one line at zero.
Arm straight_seven() {
  constexpr double deg = kPi / 180;
  const Vector3d none(0, 0, 0);
  return testing::make_arm("straight seven",
                           {{{0, 0, 0.1575}, none, {0, 0, 1}, -170 * deg, 170 * deg},
                            {{0, 0, 0.2025}, none, {0, 1, 0}, -120 * deg, 120 * deg},
                            {{0, 0, 0.2045}, none, {0, 0, 1}, -170 * deg, 170 * deg},
                            {{0, 0, 0.2155}, none, {0, -1, 0}, -120 * deg, 120 * deg},
                            {{0, 0, 0.1845}, none, {0, 0, 1}, -170 * deg, 170 * deg},
                            {{0, 0, 0.2155}, none, {0, 1, 0}, -120 * deg, 120 * deg},
                            {{0, 0, 0.081}, none, {0, 0, 1}, -175 * deg, 175 * deg}},
                           {{0, 0, 0.045}, Eigen::Matrix3d::Identity()});
}

/// UR5e whose shoulder has stops where the straight wrist leaves a narrow way.
Arm narrow_shoulder() {
  Arm arm = testing::ur5e();
  arm.limits.lower[1] = -0.75 * kPi;
  arm.limits.upper[1] = 0.75 * kPi;
  return arm;
}

struct HardArm {
  const char* name;
  Arm (*make)();
};

class HardPoses : public ::testing::TestWithParam<HardArm> {
 protected:
  void expect_solved(const std::function<JointVec(Rng&)>& draw) {
    const IkSolver ik(arm_);
    int missed = 0;
    for (int i = 0; i < testing::rounds(300, 3000, 10); ++i) {
      const JointVec q = draw(rng_);
      const Pose X_WT = fk(arm_, as_span(q));
      const auto answer = ik.solve(X_WT, as_span(testing::random_q(arm_, rng_)));
      if (!answer) {
        ++missed;
        std::cout << describe(answer.error(), arm_) << " at\n" << q.transpose() << '\n';
        continue;
      }
      const Pose X = fk(arm_, as_span(answer->q));
      EXPECT_LT((X.p - X_WT.p).norm(), 1.01e-7);
      EXPECT_LT(angle_between(X.R, X_WT.R), 1.01e-7);
      EXPECT_TRUE(within_limits(arm_, as_span(answer->q)));
    }
    EXPECT_EQ(missed, 0);
  }

  /// Every joint with probability `share` at one of its limits, `inside` of it.
  JointVec at_limits(double share, double inside, Rng& rng) const {
    JointVec q = testing::random_q(arm_, rng);
    for (int i = 0; i < arm_.dof(); ++i) {
      const double side = rng.uniform();
      if (side < share / 2) q[i] = arm_.limits.lower[i] + inside;
      if (side > 1 - share / 2) q[i] = arm_.limits.upper[i] - inside;
    }
    return q;
  }

  /// Joints of `q` with probability `share` at zero.
  JointVec with_zeros(JointVec q, double share, Rng& rng) const {
    for (int i = 0; i < arm_.dof(); ++i) {
      if (rng.uniform() < share) q[i] = 0;
    }
    return clamp_to_limits(arm_, as_span(q));
  }

  const Arm arm_ = GetParam().make();
  Rng rng_{1200};
};

TEST_P(HardPoses, SomeJointsAtLimits) {
  expect_solved([&](Rng& rng) { return at_limits(0.4, 0, rng); });
}

TEST_P(HardPoses, SomeJointsJustInside) {
  expect_solved([&](Rng& rng) { return at_limits(0.5, 1e-3, rng); });
}

TEST_P(HardPoses, HalfOfTheJointsAtZero) {
  expect_solved([&](Rng& rng) { return with_zeros(testing::random_q(arm_, rng), 0.5, rng); });
}

TEST_P(HardPoses, EveryJointAtALimitOrZero) {
  expect_solved([&](Rng& rng) { return with_zeros(at_limits(1, 0, rng), 0.33, rng); });
}

INSTANTIATE_TEST_SUITE_P(Arms, HardPoses,
                         ::testing::Values(HardArm{"NearlyParallel", nearly_parallel},
                                           HardArm{"StraightSeven", straight_seven},
                                           HardArm{"NarrowShoulder", narrow_shoulder}),
                         [](const auto& arm) { return std::string(arm.param.name); });

/// What a form with a defect cannot tell is told once the search agrees.
TEST(HardPosesTold, ALimitOfANearFormIsNamed) {
  const Arm arm = nearly_parallel();
  const IkSolver ik(arm);
  Rng rng(1201);
  int named = 0;
  for (int i = 0; i < 50; ++i) {
    JointVec q = testing::random_q(arm, rng);
    q[4] = arm.limits.upper[4] + 0.2;
    const auto answer = ik.solve(fk(arm, as_span(q)), as_span(arm.home));
    if (answer) continue;
    EXPECT_EQ(answer.error().code, IkErrc::joint_limit) << describe(answer.error(), arm);
    EXPECT_LT(answer.error().amount, 0.2 + 1e-3);
    ++named;
  }
  EXPECT_GT(named, 25);
}

}  // namespace
}  // namespace mjarm
