#include "mjarm/kinematics/posture.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "mjarm/kinematics/arms_test.hpp"

namespace mjarm {
namespace {

/// The upper arm of a UR5e rises and its forearm falls, or the other way round.
const JointVec kUp = joint_vec(std::vector<double>{0.0, -0.8, 1.5, -2.2, -1.57, 0.0});
const JointVec kDown = joint_vec(std::vector<double>{0.0, 0.7, -1.5, -0.8, -1.57, 0.0});

TEST(Posture, AnElbowThatIsUpIsBetter) {
  const PostureCost cost{IkSolver(testing::ur5e())};
  EXPECT_LT(cost.at(as_span(kUp)), cost.at(as_span(kDown)));
}

TEST(Posture, ClearanceWeighsMoreThanTheElbow) {
  const PostureCost cost{IkSolver(testing::ur5e())};
  EXPECT_GT(cost.at(as_span(kUp), 0.01), cost.at(as_span(kDown), 0.2));
  // More than enough is no better than enough.
  EXPECT_EQ(cost.at(as_span(kUp), 0.2), cost.at(as_span(kUp), 1.0));
  EXPECT_EQ(cost.at(as_span(kUp), -1.0), cost.at(as_span(kUp), 0.0));
}

TEST(Posture, TheMiddleOfTheLimitsIsBetter) {
  const Arm arm = testing::panda();
  const PostureCost cost(IkSolver(arm), {.elbow = 0});
  const JointVec middle = 0.5 * (arm.limits.lower + arm.limits.upper);
  EXPECT_EQ(cost.at(as_span(middle)), 0);
  EXPECT_NEAR(cost.at(as_span(arm.limits.upper)), cost.weights().middle, 1e-12);
  for (Eigen::Index i = 0; i < middle.size(); ++i) {
    JointVec q = middle;
    q[i] = arm.limits.lower[i];
    EXPECT_GT(cost.at(as_span(q)), 0) << i;
  }
}

TEST(Posture, SortsTheBestFirstAndTellsTheCosts) {
  const PostureCost cost{IkSolver(testing::ur5e())};
  std::vector<JointVec> answers{kDown, kUp};
  const auto costs = sort_by_posture(cost, answers, as_span(kUp), {});
  EXPECT_EQ(answers.front(), kUp);
  ASSERT_EQ(costs.size(), 2U);
  EXPECT_TRUE(std::ranges::is_sorted(costs));
  EXPECT_EQ(costs.front(), cost.at(as_span(kUp)));
  const auto tight = [](std::span<const double> q) { return q[1] < 0 ? 0.0 : 1.0; };
  sort_by_posture(cost, answers, as_span(kUp), tight);
  EXPECT_EQ(answers.front(), kDown);
}

TEST(Posture, OfEquallyGoodOnesTheNearerIsTaken) {
  const PostureCost cost(IkSolver(testing::ur5e()), {.middle = 0});
  JointVec wound = kUp;
  wound[5] += 3;
  std::vector<JointVec> answers{wound, kUp};
  sort_by_posture(cost, answers, as_span(kUp), {});
  EXPECT_EQ(answers.front(), kUp);
}

}  // namespace
}  // namespace mjarm
