#include "mjarm/kinematics/reach.hpp"

#include <gtest/gtest.h>

#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/axis_chain_internal.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"

namespace mjarm {
namespace {

using testing::panda;
using testing::random_arm;
using testing::random_q;
using testing::ur5e;

/// Random configurations, none of whose poses may be called unreachable.
void expect_nothing_excluded(const Arm& arm, int rounds, Rng& rng) {
  const Reach reach(arm);
  for (int i = 0; i < rounds; ++i) {
    const JointVec q = random_q(arm, rng);
    const Pose X_WT = fk(arm, as_span(q));
    const std::optional<ReachBreach> breach = reach.check(X_WT);
    ASSERT_FALSE(reach.check_position(X_WT.p).has_value());
    ASSERT_FALSE(breach.has_value())
        << arm.dof() << " joints, shape " << static_cast<int>(breach->shape) << " by "
        << breach->amount << " at " << q.transpose();
  }
}

TEST(Reach, NeverExcludesWhatTheUr5eReaches) {
  Rng rng(21);
  expect_nothing_excluded(ur5e(), testing::rounds(100'000, 100'000, 10'000), rng);
  expect_nothing_excluded(ur5e(true), 10000, rng);
}

TEST(Reach, NeverExcludesWhatThePandaReaches) {
  Rng rng(22);
  expect_nothing_excluded(panda(), testing::rounds(100'000, 100'000, 10'000), rng);
}

TEST(Reach, NeverExcludesWhatRandomArmsReach) {
  Rng rng(23);
  for (int round = 0; round < 500; ++round) {
    expect_nothing_excluded(random_arm(1 + round % 10, rng), 200, rng);
  }
}

/// Arms of the class that has a cylinder: parallel middle axes, across the first; wrist random.
TEST(Reach, NeverExcludesWhatArmsWithParallelAxesReach) {
  Rng rng(24);
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  int cylinders = 0;
  for (int round = 0; round < 300; ++round) {
    const auto number = [&] { return rng.uniform(-0.3, 0.3); };
    const auto anywhere = [&] { return Eigen::Vector3d(number(), number(), number()); };
    std::vector<testing::JointRow> rows{{anywhere(), {0, 0, number()}, {0, 0, 1}, -3, 3}};
    for (int i = 0; i < 1 + round % 3; ++i) {
      rows.push_back({anywhere(), {0, number(), 0}, y, -2, 2});
    }
    for (int i = 0; i < round % 4; ++i) {
      rows.push_back({0.2 * anywhere(), 3 * anywhere(), anywhere(), -2, 2});
    }
    const Arm arm =
        testing::make_arm("side", rows, {0.3 * anywhere(), Eigen::Matrix3d::Identity()});
    cylinders += Reach(arm).cylinder() > 0 ? 1 : 0;
    expect_nothing_excluded(arm, 300, rng);
  }
  EXPECT_GT(cylinders, 100);
}

TEST(Reach, RadiiOfTheUr5e) {
  const Reach reach(ur5e());
  EXPECT_NEAR(reach.cylinder(), 0.134, 1e-8);
  EXPECT_NEAR(reach.outer(), std::hypot(0.425 + 0.392 + 0.1, 0.134), 1e-8);
  EXPECT_LT((reach.base_point() - Eigen::Vector3d(0, 0, 0.163)).norm(), 1e-4);
}

TEST(Reach, RadiiOfThePanda) {
  const Reach reach(panda());
  // Straight elbow (within the limits of joint 4), then the 0.088 m between the axes 6 and 7.
  const double straight = std::hypot(0.316, 0.0825) + std::hypot(0.384, 0.0825);
  EXPECT_NEAR(reach.outer(), straight + 0.088, 1e-6);
  EXPECT_EQ(reach.cylinder(), 0);
  EXPECT_GT(reach.inner(), 0.05);  // joint 4 stops the elbow from folding any further
}

/// The bounds are reached, so no smaller ones would be true.
TEST(Reach, BoundsOfTheUr5eAreTight) {
  const Arm arm = ur5e();
  const Reach reach(arm);
  const auto distance = [&](const std::vector<double>& q) {
    std::vector<Pose> X_WJ(6);
    fk_all(arm, q, X_WJ);
    return (X_WJ[5].p - Eigen::Vector3d(0, 0, 0.163)).norm();
  };
  // Elbow straight and the short link between the axes 4 and 6 in line with it.
  EXPECT_NEAR(distance({0.2, 0.4, 0, -std::numbers::pi / 2, 0.7, 0}), reach.outer(), 1e-8);
}

TEST(Reach, SaysByHowMuch) {
  const Arm arm = ur5e();
  const Reach reach(arm);
  Pose X_WT;  // z-out tool looks along world z, so that the wrist centre lies 0.1 m below it
  X_WT.p = {2, 0, 0.163 + 0.1};
  const auto far = reach.check(X_WT);
  ASSERT_TRUE(far.has_value());
  EXPECT_EQ(far->shape, ReachShape::outer_sphere);
  EXPECT_NEAR(far->amount, 2 - reach.outer(), 1e-8);
  EXPECT_EQ(far->bound, reach.outer());
  X_WT.p = {0.1, 0, 0.7};
  const auto near = reach.check(X_WT);
  ASSERT_TRUE(near.has_value());
  EXPECT_EQ(near->shape, ReachShape::cylinder);
  EXPECT_NEAR(near->amount, 0.034, 1e-8);
  X_WT.p = {0.3, 0.2, 0.5};
  EXPECT_FALSE(reach.check(X_WT).has_value());
}

TEST(Reach, APositionIsOutOfReachInEveryOrientation) {
  const Reach reach(ur5e());
  // The wrist centre lies 0.1 m from the tool, on whichever side.
  const double outer = reach.outer() + 0.1;
  const auto far = reach.check_position({outer + 0.01, 0, 0.163});
  ASSERT_TRUE(far.has_value());
  EXPECT_EQ(far->shape, ReachShape::outer_sphere);
  EXPECT_NEAR(far->amount, 0.01, 1e-6);
  EXPECT_NEAR(far->bound, outer, 1e-6);
  EXPECT_FALSE(reach.check_position({outer - 0.01, 0, 0.163}).has_value());
  const auto near = reach.check_position({0.02, 0, 0.7});
  ASSERT_TRUE(near.has_value());
  EXPECT_EQ(near->shape, ReachShape::cylinder);
  EXPECT_NEAR(near->amount, 0.034 - 0.02, 1e-6);
  EXPECT_FALSE(reach.check_position({0.04, 0, 0.7}).has_value());
}

TEST(Reach, ToolAlongTheLastAxisChangesNothing) {
  Arm arm = ur5e();
  const double outer = Reach(arm).outer();
  arm.X_JT.p.y() += 0.3;
  EXPECT_NEAR(Reach(arm).outer(), outer, 1e-9);
}

TEST(Reach, EndlessSlideHasNoBound) {
  const double inf = std::numeric_limits<double>::infinity();
  const Arm arm = testing::make_arm(
      "rail", {{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, -inf, inf, JointType::slide}}, Pose{});
  EXPECT_FALSE(Reach(arm).check({{1e6, 0, 0}, Eigen::Matrix3d::Identity()}).has_value());
}

TEST(DistanceAcross, MatchesSampling) {
  Rng rng(25);
  const auto vec = [&] {
    return Eigen::Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
  };
  for (int round = 0; round < 300; ++round) {
    const Eigen::Vector3d u = vec(), v = vec(), a = vec().normalized();
    const double lower = rng.uniform(-4, 4);
    const double upper = lower + rng.uniform(0, 7);
    const DistanceRange range = distance_across(u, v, a, lower, upper);
    double low = 1e9, high = 0;
    for (int i = 0; i <= 2000; ++i) {
      const double angle = lower + (upper - lower) * i / 2000;
      const double d = (u - rotation_exp(a * angle) * v).norm();
      low = std::min(low, d);
      high = std::max(high, d);
    }
    EXPECT_LE(range.low, low + 1e-12);
    EXPECT_GE(range.high, high - 1e-12);
    EXPECT_NEAR(range.low, low, 5e-3);
    EXPECT_NEAR(range.high, high, 1e-4);
  }
}

}  // namespace
}  // namespace mjarm
