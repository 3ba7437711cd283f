#include "mjarm/kinematics/singularity.hpp"

#include <gtest/gtest.h>

#include "mjarm/kinematics/arms_test.hpp"
#include "tests/support/constants.hpp"

namespace mjarm {
namespace {

using support::kPi;

TEST(Singularity, KindsOfTheUr5e) {
  const IkSolver ik(testing::ur5e());
  const auto at = [&](const std::vector<double>& q) { return singularity(ik, q); };
  const Singularity wrist = at({0.3, -1.1, 1.2, 0.4, 0, 0.2});
  EXPECT_EQ(wrist.kind, SingularKind::wrist);
  EXPECT_LT(wrist.smallest, 1e-12);
  EXPECT_EQ(at({0.3, -1.1, 1.2, 0.4, kPi, 0.2}).kind, SingularKind::wrist);
  EXPECT_EQ(at({0.3, -1.1, 0, 0.4, 1.1, 0.2}).kind, SingularKind::elbow);
  // Upper arm upright, forearm upright on it, the short link above: the wrist
  // centre on axis 1's plane.
  const Singularity shoulder = at({0.3, -kPi / 2, 0.001, -kPi / 2 + 0.001, 1.2, 0.2});
  EXPECT_NE(shoulder.kind, SingularKind::none);
  const Singularity far = at({0.3, -1.1, 1.2, 0.4, 1.1, 0.2});
  EXPECT_EQ(far.kind, SingularKind::none);
  EXPECT_GT(far.smallest, 0.02);
}

/// Whatever the smallest singular value says, the kind agrees with what is near
/// zero.
TEST(Singularity, OnlySingularConfigurationsAreNear) {
  const Arm arm = testing::ur5e();
  const IkSolver ik(arm);
  Rng rng(95);
  for (int i = 0; i < 500; ++i) {
    JointVec q = testing::random_q(arm, rng);
    EXPECT_EQ(singularity(ik, as_span(q)).kind == SingularKind::none,
              singularity(ik, as_span(q)).smallest > 0.02);
    q[4] = kPi * static_cast<double>(rng.below(3)) - kPi;
    EXPECT_LT(singularity(ik, as_span(q)).smallest, 1e-10);
    EXPECT_NE(singularity(ik, as_span(q)).kind, SingularKind::none);
  }
}

TEST(Singularity, OtherArmsAreNotToldApart) {
  const IkSolver ik(testing::panda());
  EXPECT_EQ(singularity(ik, std::vector<double>(7, 0.0)).kind, SingularKind::other);
  for (const SingularKind kind : {SingularKind::none, SingularKind::shoulder, SingularKind::elbow,
                                  SingularKind::wrist, SingularKind::other}) {
    EXPECT_FALSE(name(kind).empty());
  }
}

}  // namespace
}  // namespace mjarm
