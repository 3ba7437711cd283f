#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cstring>

#include "mjarm/core/cpu.hpp"
#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik_search_internal.hpp"
#include "mjarm/kinematics/lane_search_internal.hpp"

namespace mjarm {
namespace {

using detail::DescentBlock;
using detail::DescentOptions;
using detail::kBlock;
using detail::LaneDescentEnd;
using detail::LaneSearch;

/// Lanes at random configurations of `arm`, the odd ones with a joint at its limit.
DescentBlock random_block(const Arm& arm, Rng& rng) {
  DescentBlock out;
  for (int lane = 0; lane < kBlock; ++lane) {
    JointVec q = testing::random_q(arm, rng);
    const auto joint = static_cast<Eigen::Index>(rng.below(static_cast<std::uint64_t>(arm.dof())));
    if (lane % 2 == 1) q[joint] = arm.limits.lower[joint];
    for (int i = 0; i < arm.dof(); ++i) out.q[i][lane] = q[i];
  }
  return out;
}

/// The same step, written plainly: damped least squares in the joints that are not held.
JointVec plain_step(const Arm& arm, const Pose& X_goal, const DescentOptions& options,
                    const JointVec& q, double& error) {
  const FkJacobian at = fk_jacobian(arm, as_span(q));
  const Eigen::AngleAxisd turn(X_goal.R * at.X_WT.R.transpose());
  Eigen::Matrix<double, 6, 1> e;
  e << (X_goal.p - at.X_WT.p) / options.length, 2 * std::sin(0.5 * turn.angle()) * turn.axis();
  error = e.squaredNorm();
  Eigen::MatrixXd J = at.J_W;
  J.topRows(3) /= options.length;
  const Eigen::VectorXd pull = J.transpose() * e;
  const Chain chain(arm);
  for (int i = 0; i < arm.dof(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (chain.full_turn[k]) continue;
    if ((q[i] <= chain.lower[k] && pull[i] < 0) || (q[i] >= chain.upper[k] && pull[i] > 0)) {
      J.col(i).setZero();
    }
  }
  const Eigen::MatrixXd A =
      J * J.transpose() + (0.1 * error + 1e-12) * Eigen::MatrixXd::Identity(6, 6);
  JointVec next = q + JointVec(J.transpose() * solve_symmetric(A, e));
  for (int i = 0; i < arm.dof(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!chain.full_turn[k]) next[i] = std::clamp(next[i], chain.lower[k], chain.upper[k]);
  }
  return next;
}

JointVec lane_of(const double (&rows)[kMaxDof][kBlock], int lane, int dof) {
  JointVec out(dof);
  for (int i = 0; i < dof; ++i) out[i] = rows[i][lane];
  return out;
}

TEST(LaneSearch, StepIsThatOfDampedLeastSquares) {
  Rng rng(1);
  for (int round = 0; round < 60; ++round) {
    const Arm arm = testing::random_arm(3 + round % 14, rng);
    const Chain chain(arm);
    DescentOptions options;
    options.length = 0.7;
    const Pose X_goal = fk(arm, as_span(testing::random_q(arm, rng)));
    DescentBlock block = random_block(arm, rng);
    detail::descent_kernel()(chain, X_goal, options, block);
    for (int lane = 0; lane < kBlock; ++lane) {
      double error = 0;
      const JointVec q = lane_of(block.q, lane, arm.dof());
      const JointVec next = plain_step(arm, X_goal, options, q, error);
      EXPECT_NEAR(block.error[lane], error, 1e-9);
      EXPECT_LT((lane_of(block.next, lane, arm.dof()) - next).norm(), 1e-6 * (1 + next.norm()));
    }
  }
}

#if defined(__x86_64__)
TEST(LaneSearch, WidthsOfRegistersAgree) {
  Rng rng(2);
  const Arm arm = testing::panda();
  const Chain chain(arm);
  DescentOptions options;
  const Pose X_goal = fk(arm, as_span(testing::random_q(arm, rng)));
  DescentBlock narrow = random_block(arm, rng);
  DescentBlock wide = narrow;
  detail::descent_step_baseline(chain, X_goal, options, narrow);
  for (const SimdLevel level : {SimdLevel::avx2, SimdLevel::avx512}) {
    if (simd_level() < level) continue;
    const auto step =
        level == SimdLevel::avx2 ? detail::descent_step_avx2 : detail::descent_step_avx512;
    step(chain, X_goal, options, wide);
    for (int lane = 0; lane < kBlock; ++lane) {
      EXPECT_NEAR(wide.error[lane], narrow.error[lane], 1e-11);
      EXPECT_LT((lane_of(wide.next, lane, 7) - lane_of(narrow.next, lane, 7)).norm(), 1e-9);
    }
  }
}
#endif

/// The first answer to a pose from a seed.
std::optional<LaneDescentEnd> first_answer(const Chain& chain, const Pose& X_goal,
                                           const JointVec& seed, int starts) {
  DescentOptions options;
  options.length = detail::characteristic_length(chain);
  Rng rng(1);
  LaneSearch search(chain, X_goal, options, seed, starts, rng);
  while (std::optional<LaneDescentEnd> end = search.next()) {
    if (end->descent.converged) return end;
  }
  return std::nullopt;
}

TEST(LaneSearch, SolvesEveryPoseOfUr5eAndPanda) {
  Rng rng(3);
  for (const Arm& arm : {testing::ur5e(), testing::panda()}) {
    const Chain chain(arm);
    for (int i = 0; i < 5000; ++i) {
      const Pose X_goal = fk(arm, as_span(testing::random_q(arm, rng)));
      const JointVec seed = testing::random_q(arm, rng);
      const auto end = first_answer(chain, X_goal, seed, 51);
      ASSERT_TRUE(end.has_value()) << arm.name << i;
      const JointVec q = unwind(chain, end->descent.q, seed);
      EXPECT_TRUE(within_limits(arm, as_span(q)));
      EXPECT_LT((fk(arm, as_span(q)).p - X_goal.p).norm(), 1.01e-7);
      const auto again = first_answer(chain, X_goal, seed, 51);
      EXPECT_EQ(std::memcmp(end->descent.q.data(), again->descent.q.data(),
                            sizeof(double) * static_cast<std::size_t>(arm.dof())),
                0);
    }
  }
}

TEST(LaneSearch, ASeedThatIsNearWins) {
  Rng rng(4);
  for (const Arm& arm : {testing::ur5e(), testing::panda()}) {
    const Chain chain(arm);
    for (int i = 0; i < 1000; ++i) {
      const JointVec q = testing::random_q(arm, rng);
      const JointVec away = testing::random_q(arm, rng) - q;
      const JointVec seed = clamp_to_limits(arm, as_span(JointVec(q + 0.02 * away.normalized())));
      const auto end = first_answer(chain, fk(arm, as_span(q)), seed, 51);
      ASSERT_TRUE(end.has_value());
      EXPECT_EQ(end->start, 0);
    }
  }
}

TEST(LaneSearch, EveryStartEndsOnce) {
  const Arm arm = testing::ur5e();
  const Chain chain(arm);
  const Pose X_far{{3, 0, 0}, Eigen::Matrix3d::Identity()};
  DescentOptions options;
  for (const int starts : {1, 3, 8, 21}) {
    Rng rng(5);
    LaneSearch search(chain, X_far, options, arm.home, starts, rng);
    std::vector<int> ended;
    while (const auto end = search.next()) {
      EXPECT_FALSE(end->descent.converged);
      EXPECT_EQ(end->descent.q.size(), 6);
      ended.push_back(end->start);
    }
    std::sort(ended.begin(), ended.end());
    ASSERT_EQ(ended.size(), static_cast<std::size_t>(starts));
    for (int i = 0; i < starts; ++i) EXPECT_EQ(ended[static_cast<std::size_t>(i)], i);
  }
}

}  // namespace
}  // namespace mjarm
