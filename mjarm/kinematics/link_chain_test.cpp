#include "mjarm/kinematics/link_chain.hpp"

#include <gtest/gtest.h>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/trig_internal.hpp"

namespace mjarm {
namespace {

void expect_same(const Arm& arm, const JointVec& q, double tol) {
  const LinkChain chain{Chain(arm)};
  const FkJacobian expected = fk_jacobian(arm, as_span(q));
  const FkJacobian got = fk_jacobian(chain, as_span(q));
  EXPECT_LT((got.X_WT.p - expected.X_WT.p).norm(), tol);
  EXPECT_LT((got.X_WT.R - expected.X_WT.R).norm(), tol);
  ASSERT_EQ(got.J_W.cols(), arm.dof());
  EXPECT_LT((got.J_W - expected.J_W).norm(), tol);
  const Pose X_WT = fk(chain, as_span(q));
  EXPECT_LT((X_WT.p - expected.X_WT.p).norm() + (X_WT.R - expected.X_WT.R).norm(), tol);
}

TEST(LinkChain, MatchesTheArm) {
  Rng rng(97);
  for (int i = 0; i < 200; ++i) {
    expect_same(testing::ur5e(i % 2 == 0), testing::random_q(testing::ur5e(), rng), 1e-13);
    expect_same(testing::panda(), testing::random_q(testing::panda(), rng), 1e-13);
  }
  for (int dof = 1; dof <= kMaxDof; ++dof) {
    for (int i = 0; i < 30; ++i) {
      const Arm arm = testing::random_arm(dof, rng);
      expect_same(arm, testing::random_q(arm, rng), 1e-12);
    }
  }
}

/// A tool that is only moved and turned about the last axis.
TEST(LinkChain, ToolsThatStandStraight) {
  Rng rng(99);
  for (int i = 0; i < 300; ++i) {
    Arm arm = testing::random_arm(1 + i % 8, rng);
    const Eigen::Vector3d axis = arm.joints.back().axis;
    arm.X_JT.R =
        rotation_exp(rng.uniform(-3, 3) * axis) * rotation_between(Eigen::Vector3d::UnitZ(), axis);
    EXPECT_FALSE(LinkChain(Chain(arm)).tool_turns);
    expect_same(arm, testing::random_q(arm, rng), 1e-12);
  }
}

TEST(LinkChain, AnglesOfManyTurnsAreTaken) {
  expect_same(testing::ur5e(), JointVec::Constant(6, 1234.5), 1e-11);
  expect_same(testing::ur5e(), JointVec::Constant(6, -3e6), 1e-8);
}

TEST(Trig, MatchesTheLibrary) {
  Rng rng(98);
  for (int i = 0; i < 200000; ++i) {
    const double x = rng.uniform(-1, 1) * (i % 2 == 0 ? 7 : 90000);
    const detail::SinCos at = detail::sin_cos(x);
    EXPECT_NEAR(at.s, std::sin(x), 3e-16);
    EXPECT_NEAR(at.c, std::cos(x), 3e-16);
    const double y = rng.uniform(-1, 1);
    const double z = rng.uniform(-1, 1) * (i % 3 == 0 ? 1e-9 : 1);
    EXPECT_NEAR(detail::arc_tangent(y, z), std::atan2(y, z), 1e-15);
  }
  EXPECT_EQ(detail::arc_tangent(0, 0), 0);
  EXPECT_DOUBLE_EQ(detail::arc_tangent(0, -1), std::numbers::pi);
  EXPECT_DOUBLE_EQ(detail::arc_tangent(1, 0), std::numbers::pi / 2);
}

}  // namespace
}  // namespace mjarm
