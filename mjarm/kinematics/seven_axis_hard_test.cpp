#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/hard_negatives_test.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"
#include "mjarm/kinematics/panda_sweep_test.hpp"

/// Poses near what the Panda can reach and yet out of it, confirmed by PandaSweep and by descents
/// from 200 random starts.
namespace mjarm {
namespace {

using testing::normal_vector;
using testing::panda;
using testing::PandaSweep;
using testing::random_q;

constexpr double kDoubt = 1e-6;  // [rad] the sweep is not believed to be more exact than this

int negatives(int many) { return testing::rounds(many / 5, many, 10); }

/// Draws poses until `count` of them have no answer by the sweep, and compares what the solver says
/// of all of them. Returns the reasons given.
std::map<IkErrc, int> compare(int count, Rng& rng, const std::function<Pose()>& draw) {
  const Arm arm = panda();
  const IkSolver ik(arm);
  const PandaSweep sweep(arm);
  std::map<IkErrc, int> reasons;
  int refused = 0;
  while (refused < count) {
    const Pose X_WT = draw();
    const double least = sweep.least_breach(X_WT);
    const auto answer = ik.solve(X_WT, as_span(random_q(arm, rng)));
    if (std::abs(least) < kDoubt) continue;
    if (least < 0) {
      // Never a proof against what can be reached.
      EXPECT_TRUE(answer || answer.error().code == IkErrc::no_convergence)
          << least << ' ' << describe(answer.error(), arm);
      continue;
    }
    ++refused;
    EXPECT_FALSE(answer.has_value()) << least;
    if (answer) continue;
    const IkFailure& failure = answer.error();
    ++reasons[failure.code];
    EXPECT_TRUE(testing::nothing_found(ik, X_WT)) << least << ' ' << describe(failure, arm);
    EXPECT_TRUE(within_limits(arm, as_span(failure.best.q)));
    if (failure.code == IkErrc::joint_limit) {
      EXPECT_LT(least, PandaSweep::kNever) << describe(failure, arm);
      EXPECT_GT(failure.amount, least - kDoubt) << describe(failure, arm);
    }
    if (least >= PandaSweep::kNever) {
      EXPECT_NE(failure.code, IkErrc::joint_limit);
    }
  }
  // No bound may prove what lies a hair's breadth beyond the rim.
  EXPECT_LE(reasons[IkErrc::no_convergence], count / 50);
  return reasons;
}

/// The judge itself: it finds what can be reached, however near to a limit.
TEST(PandaSweep, FindsWhatCanBeReached) {
  const Arm arm = panda();
  const PandaSweep sweep(arm);
  Rng rng(110);
  for (int i = 0; i < testing::rounds(400, 5000); ++i) {
    const JointVec q = testing::random_q_near_limits(arm, rng);
    EXPECT_LT(sweep.least_breach(fk(arm, as_span(q))), kDoubt) << i << ' ' << q.transpose();
  }
}

TEST(SevenAxisHard, InsideVoids) {
  const Arm arm = panda();
  Rng rng(111);
  const int count = negatives(250);
  auto reasons = compare(count, rng, [&] {
    Pose X;
    X.R = rotation_exp(2 * normal_vector(rng));
    X.p = Eigen::Vector3d(0, 0, 0.333) + rng.uniform(0.02, 0.4) * normal_vector(rng).normalized();
    return X;
  });
  EXPECT_GT(reasons[IkErrc::inner_void], count / 3);
  EXPECT_GT(reasons[IkErrc::joint_limit], count / 5);
}

TEST(SevenAxisHard, BeyondALimitOnly) {
  const Arm arm = panda();
  Rng rng(112);
  const int count = negatives(250);
  auto reasons = compare(count, rng, [&] {
    JointVec q = random_q(arm, rng);
    const auto joint = static_cast<Eigen::Index>(rng.below(7));
    const double beyond = rng.uniform(0.01, 0.4);
    q[joint] =
        rng.uniform() < 0.5 ? arm.limits.lower[joint] - beyond : arm.limits.upper[joint] + beyond;
    return fk(arm, as_span(q));
  });
  EXPECT_GT(reasons[IkErrc::joint_limit], count / 2);
}

TEST(SevenAxisHard, TheWrongWayRoundAtTheRim) {
  const Arm arm = panda();
  Rng rng(113);
  const int count = negatives(250);
  auto reasons = compare(count, rng, [&] {
    JointVec q = random_q(arm, rng);
    q[3] = rng.uniform(-0.7, arm.limits.upper[3]);
    return testing::moved(fk(arm, as_span(q)), 0, 1, rng);
  });
  EXPECT_GT(reasons[IkErrc::out_of_reach], count / 2);
}

}  // namespace
}  // namespace mjarm
