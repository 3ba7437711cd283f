#include "mjarm/kinematics/general_six.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mjarm/core/cpu.hpp"
#include "mjarm/kinematics/branches_internal.hpp"
#include "mjarm/kinematics/descent_internal.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/general_arms_test.hpp"
#include "mjarm/kinematics/general_six_internal.hpp"
#include "mjarm/kinematics/ik_search_internal.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"

namespace mjarm {
namespace {

using BranchRows = std::vector<JointVec>;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kSame = 1e-3;  // [rad] of all joints: one branch

double apart(const JointVec& a, const JointVec& b) {
  double out = 0;
  for (int i = 0; i < 6; ++i) out = std::max(out, std::abs(std::remainder(a[i] - b[i], kTurn)));
  return out;
}

bool knows(const BranchRows& rows, const JointVec& q) {
  return std::ranges::any_of(rows, [&](const JointVec& row) { return apart(row, q) < kSame; });
}

/// The distinct branches that the form finds; each must reach the pose.
BranchRows branches_of(const Arm& arm, const GeneralSix& form, const Pose& X_WT) {
  detail::Branches branches;
  const double near[6] = {};
  detail::ClosedForm::branches(form, {X_WT, near, 1e-7, 1e-7, true}, branches);
  BranchRows out;
  for (int i = 0; i < branches.count; ++i) {
    const JointVec q = Eigen::Map<const Eigen::VectorXd>(branches.q[i], 6);
    const Pose X = fk(arm, as_span(q));
    EXPECT_LT((X.p - X_WT.p).norm(), 2e-5) << arm.name;
    EXPECT_LT(angle_between(X.R, X_WT.R), 2e-5) << arm.name;
    if (!knows(out, q)) out.push_back(q);
  }
  EXPECT_LE(out.size(), 16U) << arm.name;
  return out;
}

/// Another way to find them: descents from random starts.
BranchRows branches_by_search(const Arm& arm, const Pose& X_WT, int starts, Rng& rng) {
  const Chain chain(arm);
  detail::DescentOptions options;
  options.limits = false;
  options.length = detail::characteristic_length(chain);
  BranchRows out;
  for (int i = 0; i < starts; ++i) {
    JointVec start(6);
    for (double& q : start) q = rng.uniform(-std::numbers::pi, std::numbers::pi);
    const auto descent = detail::descend(chain, X_WT, start, options);
    if (descent.converged && !knows(out, descent.q)) out.push_back(descent.q);
  }
  return out;
}

GeneralSix form_of(const Arm& arm) {
  auto form = GeneralSix::recognise(Chain(arm));
  EXPECT_TRUE(form.has_value()) << arm.name;
  return form.value();
}

JointVec any_q(Rng& rng) {
  JointVec q(6);
  for (double& value : q) value = rng.uniform(-std::numbers::pi, std::numbers::pi);
  return q;
}

class GeneralSixArms : public ::testing::TestWithParam<int> {
 protected:
  static Arm arm() {
    return testing::general_six_axis_arms()[static_cast<std::size_t>(GetParam())];
  }
};

/// Long: 300 poses, 10,000 starts each.
TEST_P(GeneralSixArms, FindsWhatManyStartsFind) {
  const Arm arm = this->arm();
  const GeneralSix form = form_of(arm);
  Rng rng(711);
  int known = 0;
  for (int i = 0; i < testing::rounds(8, 300); ++i) {
    const Pose X_WT = fk(arm, as_span(any_q(rng)));
    const BranchRows found = branches_of(arm, form, X_WT);
    for (const JointVec& q : branches_by_search(arm, X_WT, testing::rounds(500, 10'000), rng)) {
      ++known;
      EXPECT_TRUE(knows(found, q)) << arm.name << ", pose " << i << ": " << q.transpose();
    }
  }
  EXPECT_GT(known, 20);
}

/// At thousands of poses the configuration that made it, and an even number of branches: they come
/// and go in twos.
TEST_P(GeneralSixArms, FindsTheConfigurationItself) {
  const Arm arm = this->arm();
  const GeneralSix form = form_of(arm);
  Rng rng(712);
  int lost = 0, odd = 0;
  const int poses = testing::rounds(500, 20'000);
  for (int i = 0; i < poses; ++i) {
    const JointVec q = any_q(rng);
    const BranchRows found = branches_of(arm, form, fk(arm, as_span(q)));
    lost += knows(found, q) ? 0 : 1;
    odd += found.size() % 2 == 1 ? 1 : 0;
  }
  EXPECT_LE(lost, poses / 5000) << arm.name;
  EXPECT_LE(odd, poses / 100) << arm.name;
}

/// One joint next to a quarter turn, where most singular poses are; farther than what makes two
/// branches one.
TEST_P(GeneralSixArms, FindsItNearSingularPoses) {
  const Arm arm = this->arm();
  const GeneralSix form = form_of(arm);
  Rng rng(713);
  int lost = 0;
  const int poses = testing::rounds(300, 10'000);
  for (int i = 0; i < poses; ++i) {
    JointVec q = any_q(rng);
    const double quarter = static_cast<double>(rng.below(4)) * std::numbers::pi / 2;
    const double side = rng.uniform() < 0.5 ? -1 : 1;
    q[static_cast<Eigen::Index>(rng.below(6))] = quarter + side * std::pow(10, rng.uniform(-3, -1));
    lost += knows(branches_of(arm, form, fk(arm, as_span(q))), q) ? 0 : 1;
  }
  EXPECT_LE(lost, poses / 1000) << arm.name;
}

/// The same arms with base and tool exchanged: one of the two is seen from the tool.
TEST_P(GeneralSixArms, FindsItFromTheOtherEnd) {
  const Arm arm = this->arm();
  Arm other = arm;
  other.X_JT = arm.joints[0].X_PJ.inverse();
  for (std::size_t i = 0; i < 6; ++i) {
    other.joints[i].X_PJ = (i == 0 ? arm.X_JT : arm.joints[6 - i].X_PJ).inverse();
  }
  const GeneralSix form = form_of(other);
  Rng rng(714);
  int lost = 0;
  for (int i = 0; i < 200; ++i) {
    const JointVec q = any_q(rng);
    lost += knows(branches_of(other, form, fk(other, as_span(q))), q) ? 0 : 1;
  }
  EXPECT_EQ(lost, 0) << arm.name;
}

INSTANTIATE_TEST_SUITE_P(Kinematics, GeneralSixArms, ::testing::Range(0, 12), [](const auto& arm) {
  return testing::general_six_axis_arms()[static_cast<std::size_t>(arm.param)].name;
});

/// The most that six hinges can have (E. J. F. Primrose, 1986).
TEST(GeneralSix, AnArmWithOffsetWristHasSixteenSomewhere) {
  const Arm arm = testing::built_six_axis_arms()[1];
  const GeneralSix form = form_of(arm);
  Rng rng(715);
  std::size_t most = 0;
  for (int i = 0; i < 500; ++i) {
    most = std::max(most, branches_of(arm, form, fk(arm, as_span(any_q(rng)))).size());
  }
  EXPECT_EQ(most, 16U);
}

TEST(GeneralSix, PosesOutOfReachHaveNone) {
  const Arm arm = testing::built_six_axis_arms()[0];
  EXPECT_TRUE(branches_of(arm, form_of(arm), {{3, 0, 0}, Eigen::Matrix3d::Identity()}).empty());
}

TEST(GeneralSix, IsForSixHingesThatAnswerApart) {
  EXPECT_FALSE(GeneralSix::recognise(Chain(testing::panda())).has_value());
  Arm sliding = testing::random_six(0);
  sliding.joints[2].type = JointType::slide;
  EXPECT_FALSE(GeneralSix::recognise(Chain(sliding)).has_value());
  const Arm flat = testing::dh_arm("flat", std::vector<testing::DhRow>(6, {0.2, 0, 0.1, 0}));
  EXPECT_FALSE(GeneralSix::recognise(Chain(flat)).has_value());
}

TEST(GeneralSix, EveryRegisterWidthFindsTheSame) {
  std::vector<const detail::GeneralKernel*> kernels{&detail::general_kernel_baseline()};
#if defined(__x86_64__)
  if (simd_level() >= SimdLevel::avx2) kernels.push_back(&detail::general_kernel_avx2());
  if (simd_level() >= SimdLevel::avx512) kernels.push_back(&detail::general_kernel_avx512());
#endif
  for (const Arm& arm : testing::general_six_axis_arms()) {
    const GeneralSix form = form_of(arm);
    const detail::GeneralGeometry& g = detail::ClosedForm::geometry(form);
    Rng rng(716);
    const Pose X_WT = g.chain.fk(any_q(rng).data());
    detail::GeneralEquations equations, change;
    detail::set_equations(g, g.rows.front(), X_WT, equations);
    detail::set_equations(g, g.rows.back(), X_WT, change);
    double q4[detail::kBlock], first[detail::kBlock], other[detail::kBlock];
    for (double& q : q4) q = rng.uniform(-3, 3);
    kernels[0]->determinants(g, equations, change, 0, q4, first);
    double largest = 0;
    for (const double f : first) largest = std::max(largest, std::abs(f));
    for (const auto* kernel : kernels) {
      kernel->determinants(g, equations, change, 0, q4, other);
      for (int k = 0; k < detail::kBlock; ++k) EXPECT_NEAR(other[k], first[k], 1e-8 * largest);
    }
  }
}

}  // namespace
}  // namespace mjarm
