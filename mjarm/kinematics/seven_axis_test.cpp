#include "mjarm/kinematics/seven_axis.hpp"

#include <gtest/gtest.h>

#include "mjarm/core/cpu.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/branches_internal.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"
#include "mjarm/kinematics/seven_axis_block_internal.hpp"

namespace mjarm {
namespace {

using detail::Branches;
using testing::panda;
using testing::random_q;

int rounds(int normal) { return testing::rounds(normal, 100 * normal); }

/// The offsets of an arm whose shoulder, elbow and wrist are spheres, like KUKA's iiwa.
Arm iiwa() {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const double h = std::numbers::pi / 2;
  return testing::make_arm("iiwa",
                           {{{0, 0, 0.36}, {0, 0, 0}, z, -2.96, 2.96},
                            {{0, 0, 0}, {-h, 0, 0}, z, -2.09, 2.09},
                            {{0, -0.42, 0}, {h, 0, 0}, z, -2.96, 2.96},
                            {{0, 0, 0}, {h, 0, 0}, z, -2.09, 2.09},
                            {{0, 0.4, 0}, {-h, 0, 0}, z, -2.96, 2.96},
                            {{0, 0, 0}, {-h, 0, 0}, z, -2.09, 2.09},
                            {{0, 0, 0}, {h, 0, 0}, z, -3.05, 3.05}},
                           {{0, 0, 0.126}, Eigen::Matrix3d::Identity()});
}

/// The Panda's pattern with odd angles between all axes and joints that turn without end.
Arm skewed() {
  Arm arm = panda();
  Rng rng(3);
  for (ArmJoint& joint : arm.joints) {
    const Eigen::Vector3d tilt(rng.uniform(-0.2, 0.2), rng.uniform(-0.2, 0.2), 0);
    joint.axis = from_euler(tilt) * joint.axis;
  }
  // Keep the shoulder on axis 3 and the wrist on axes 5 and 6.
  arm.joints[2].X_PJ.p.setZero();
  arm.joints[3].X_PJ.p.z() += 0.316;
  arm.joints[5].X_PJ.p.setZero();
  arm.limits.lower.setConstant(-7);
  arm.limits.upper.setConstant(7);
  return arm;
}

struct Asked {
  Branches out;
  bool within = false;
  JointVec q;
};

void ask(const SevenAxis& form, const Arm& arm, const Pose& X_WT, const JointVec& seed,
         Asked& asked, bool all = false) {
  asked.out.count = 0;
  detail::ClosedForm::branches(form, {X_WT, seed.data(), 1e-7, 1e-7, all}, asked.out);
  asked.within = false;
  if (asked.out.count == 0) return;
  asked.q = joint_vec({asked.out.q[0], 7});
  for (int i = 0; i < 7; ++i) asked.q[i] = nearest_winding(Chain(arm), i, asked.q[i], seed[i]);
  asked.within = within_limits(arm, as_span(asked.q), -1e-8);
}

/// To 2e-5 only: where a triangle just closes, within kSevenWithin, its root loses half the digits,
/// which the front wins back by Newton's steps.
void expect_reaches(const Arm& arm, const JointVec& q, const Pose& X_goal) {
  const Pose X = fk(arm, as_span(q));
  EXPECT_LT((X.p - X_goal.p).norm(), 2e-5);
  EXPECT_LT(angle_between(X.R, X_goal.R), 2e-5);
}

TEST(SevenAxis, IsRecognisedByItsGeometry) {
  for (const Arm& arm : {panda(), iiwa(), skewed()}) {
    EXPECT_TRUE(SevenAxis::recognise(Chain(arm)).has_value()) << arm.name;
  }
  EXPECT_FALSE(SevenAxis::recognise(Chain(testing::ur5e())).has_value());
  Rng rng(1);
  EXPECT_FALSE(SevenAxis::recognise(Chain(testing::random_arm(7, rng))).has_value());
  for (const std::size_t joint : {1U, 2U, 5U}) {  // axes that should meet, moved apart
    Arm arm = panda();
    arm.joints[joint].X_PJ.p.x() += 1e-3;
    EXPECT_FALSE(SevenAxis::recognise(Chain(arm)).has_value()) << joint;
  }
}

TEST(SevenAxis, FindsEveryPoseOfTheArms) {
  Asked asked;
  Rng rng(2);
  for (const Arm& arm : {panda(), iiwa(), skewed()}) {
    const auto form = SevenAxis::recognise(Chain(arm));
    ASSERT_TRUE(form.has_value());
    int found = 0;
    const int count = rounds(10000);
    for (int i = 0; i < count; ++i) {
      const Pose X_goal = fk(arm, as_span(random_q(arm, rng)));
      ask(*form, arm, X_goal, random_q(arm, rng), asked);
      found += asked.within ? 1 : 0;
      EXPECT_TRUE(asked.within || !asked.out.complete) << arm.name << i;
      if (asked.within) expect_reaches(arm, asked.q, X_goal);
    }
    EXPECT_GE(found, count - count / 2000) << arm.name;
  }
}

TEST(SevenAxis, FindsPosesAtTheEdgeOfTheLimits) {
  const Arm arm = panda();
  const auto form = SevenAxis::recognise(Chain(arm));
  Rng rng(4);
  Asked asked;
  for (int i = 0; i < rounds(3000); ++i) {
    const JointVec q = testing::random_q_near_limits(arm, rng);
    const Pose X_goal = fk(arm, as_span(q));
    ask(*form, arm, X_goal, random_q(arm, rng), asked);
    // What is missed is handed on to the numeric search, never called impossible.
    EXPECT_TRUE(asked.within || !asked.out.complete) << i;
    if (asked.within) expect_reaches(arm, asked.q, X_goal);
  }
}

TEST(SevenAxis, StaysNearASeedThatIsNear) {
  const Arm arm = panda();
  const auto form = SevenAxis::recognise(Chain(arm));
  Rng rng(5);
  Asked asked;
  for (int i = 0; i < 2000; ++i) {
    const JointVec q = random_q(arm, rng);
    const JointVec away = random_q(arm, rng) - q;
    const JointVec seed = clamp_to_limits(arm, as_span(JointVec(q + 1e-3 * away.normalized())));
    ask(*form, arm, fk(arm, as_span(q)), seed, asked);
    ASSERT_TRUE(asked.within);
    EXPECT_LT((asked.q - seed).cwiseAbs().maxCoeff(), 0.2) << i;
    ask(*form, arm, fk(arm, as_span(q)), q, asked);
    ASSERT_TRUE(asked.within);
    EXPECT_LT((asked.q - q).cwiseAbs().maxCoeff(), 1e-6) << i;
  }
}

TEST(SevenAxis, SolvesSingularPoses) {
  const Arm arm = panda();
  const auto form = SevenAxis::recognise(Chain(arm));
  const double stretched = -std::atan2(0.0825, 0.316) - std::atan2(0.0825, 0.384);
  Rng rng(6);
  Asked asked;
  for (int i = 0; i < 600; ++i) {
    JointVec q = random_q(arm, rng);
    if (i % 3 != 1) q[1] = 0;
    if (i % 3 != 0) q[3] = stretched;
    if (i % 5 == 0) q[5] = 0;
    const Pose X_goal = fk(arm, as_span(q));
    ask(*form, arm, X_goal, i % 2 == 0 ? q : random_q(arm, rng), asked);
    EXPECT_TRUE(asked.within || !asked.out.complete) << i;
  }
}

TEST(SevenAxis, SaysWhichLimitIsInTheWay) {
  Arm arm = panda();
  const auto form = SevenAxis::recognise(Chain(arm));
  Arm wide = arm;
  wide.limits.lower[5] = -1.2;
  wide.limits.upper[5] = -0.9;  // far below what joint 6 may do
  Rng rng(7);
  Asked asked;
  int only_beyond = 0, none = 0;
  for (int i = 0; i < 500; ++i) {
    const Pose X_goal = fk(arm, as_span(random_q(wide, rng)));
    ask(*form, arm, X_goal, random_q(arm, rng), asked);
    if (asked.out.count == 0) ++none;
    if (asked.within || asked.out.count == 0) continue;
    ++only_beyond;
    expect_reaches(arm, asked.q, X_goal);
    EXPECT_FALSE(within_limits(arm, as_span(asked.q)));
  }
  EXPECT_GT(only_beyond, 10);
  EXPECT_EQ(none, 0);
}

TEST(SevenAxis, ListsAnswersOfTheWholeRange) {
  const Arm arm = panda();
  const auto form = SevenAxis::recognise(Chain(arm));
  Rng rng(8);
  Asked asked;
  for (int i = 0; i < 200; ++i) {
    const Pose X_goal = fk(arm, as_span(random_q(arm, rng)));
    ask(*form, arm, X_goal, random_q(arm, rng), asked, true);
    for (int k = 0; k < asked.out.count; ++k) {
      const JointVec q = joint_vec({asked.out.q[k], 7});
      EXPECT_TRUE(within_limits(arm, as_span(q), -1e-8));
      expect_reaches(arm, q, X_goal);
    }
  }
}

TEST(SevenAxis, TooFarAndTooNearAreTold) {
  const Arm arm = panda();
  const auto form = SevenAxis::recognise(Chain(arm));
  Asked asked;
  ask(*form, arm, {{1.5, 0, 0.3}, Eigen::Matrix3d::Identity()}, arm.home, asked);
  EXPECT_EQ(asked.out.count, 0);
  EXPECT_EQ(asked.out.why, IkErrc::out_of_reach);
  EXPECT_GT(asked.out.amount, 0.6);
  EXPECT_TRUE(asked.out.complete);
}

#if defined(__x86_64__)
TEST(SevenAxis, WidthsOfRegistersAgree) {
  const Arm arm = panda();
  detail::SevenGoal goal;
  Rng rng(9);
  Asked asked;
  const auto form = SevenAxis::recognise(Chain(arm));
  const Pose X_WT = fk(arm, as_span(random_q(arm, rng)));
  const detail::SevenGeometry& geometry = detail::ClosedForm::geometry(*form);
  const Pose X_W6 = X_WT * geometry.X_T6;
  const Eigen::Vector3d p_6S =
      X_W6.R.transpose() * (Eigen::Map<const Eigen::Vector3d>(geometry.p_WS) - X_W6.p);
  std::copy_n(p_6S.data(), 3, goal.p_6S);
  const Eigen::Matrix3d R = Eigen::Map<const Eigen::Matrix3d>(geometry.R_W0).transpose() * X_W6.R;
  std::copy_n(R.data(), 9, goal.R_0u6);
  for (int i = 0; i < 7; ++i) {
    goal.near_cos[i] = 1;
    goal.near_sin[i] = 0;
  }
  double q7[detail::kBlock];
  for (double& q : q7) q = rng.uniform(-2.8, 2.8);
  detail::SevenBlock narrow, wide;
  goal.beyond_limits = true;
  detail::seven_block_baseline(geometry, goal, q7, narrow);
  for (const SimdLevel level : {SimdLevel::avx2, SimdLevel::avx512}) {
    if (simd_level() < level) continue;
    const auto kernel =
        level == SimdLevel::avx2 ? detail::seven_block_avx2 : detail::seven_block_avx512;
    kernel(geometry, goal, q7, wide);
    for (int branch = 0; branch < 8; ++branch) {
      for (int lane = 0; lane < detail::kBlock; ++lane) {
        EXPECT_NEAR(wide.beyond[branch][lane], narrow.beyond[branch][lane], 1e-9);
      }
    }
  }
}
#endif

}  // namespace
}  // namespace mjarm
