#include "mjarm/kinematics/fk.hpp"

#include <gtest/gtest.h>

#include <Eigen/SVD>

#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/compare_test.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm {
namespace {

using testing::panda;
using testing::random_arm;
using testing::random_q;
using testing::ur5e;

std::vector<double> numbers(const nlohmann::json& list, std::size_t count) {
  auto values = list.get<std::vector<double>>();
  values.resize(count);
  return values;
}

/// FK and Jacobian against the cases of another program; returns how many there were.
void compare_with_ground_truth(const Arm& arm, const std::filesystem::path& file) {
  const nlohmann::json data = support::load_json(file);
  ASSERT_GE(data.at("cases").size(), 100U);
  for (const auto& entry : data.at("cases")) {
    const std::vector<double> q = numbers(entry.at("q"), arm.joints.size());
    const Pose X_expected = testing::pose_of(entry);
    const FkJacobian got = fk_jacobian(arm, q);
    EXPECT_LT((got.X_WT.p - X_expected.p).norm(), 1e-9);
    EXPECT_LT(angle_between(got.X_WT.R, X_expected.R), 1e-9);
    for (int row = 0; row < 6; ++row) {
      for (int column = 0; column < arm.dof(); ++column) {
        EXPECT_NEAR(got.J_W(row, column), entry.at("jac").at(row).at(column).get<double>(), 1e-9);
      }
    }
  }
}

TEST(Fk, MatchesPinocchioOnTheUr5e) {
  MJARM_TEST_FILE(file, "ground_truth/ur5e_legacy_urdf.json.gz");
  compare_with_ground_truth(ur5e(true), file);
}

TEST(Fk, MatchesMujocoOnTheUr5e) {
  MJARM_TEST_FILE(file, "ground_truth/ur5e_menagerie.json.gz");
  compare_with_ground_truth(ur5e(true), file);
}

TEST(Fk, MatchesPinocchioOnThePanda) {
  MJARM_TEST_FILE(file, "ground_truth/panda_urdf.json.gz");
  Arm arm = panda();  // up to the flange; the hand is turned by -45 degrees, its tip 0.1034 m off
  arm.X_JT = arm.X_JT * Pose{Eigen::Vector3d::Zero(), from_euler({0, 0, -std::numbers::pi / 4})} *
             Pose{{0, 0, 0.1034}, Eigen::Matrix3d::Identity()};
  compare_with_ground_truth(arm, file);
}

TEST(Fk, KnownPosesOfTheUr5e) {
  const double half = std::numbers::pi / 2;
  const Arm arm = ur5e(true);
  const Pose home = fk(arm, std::vector<double>{-half, -half, half, -half, -half, 0});
  EXPECT_LT((home.p - Eigen::Vector3d(-0.134, 0.492, 0.488)).norm(), 1e-12);
  const Pose seed = fk(arm, std::vector<double>{-1.57, -1.34, 2.65, -1.3, 1.55, 0});
  EXPECT_LT((seed.p - Eigen::Vector3d(-0.136, 0.297, 0.097)).norm(), 1e-3);
  const Pose low = fk(arm, std::vector<double>{0, 0, 2.65, -1.3, 1.55, 0});
  EXPECT_NEAR(low.p.z(), -0.141, 5e-4);
}

TEST(Fk, JacobianIsTheDerivativeOfThePose) {
  Rng rng(11);
  for (int round = 0; round < 200; ++round) {
    const Arm arm = round < 2 ? (round == 0 ? ur5e() : panda()) : random_arm(1 + round % 16, rng);
    const JointVec q = random_q(arm, rng);
    const Jacobian J = fk_jacobian(arm, as_span(q)).J_W;
    constexpr double h = 1e-6;
    for (int i = 0; i < arm.dof(); ++i) {
      JointVec above = q;
      JointVec below = q;
      above[i] += h;
      below[i] -= h;
      const Pose A = fk(arm, as_span(above));
      const Pose B = fk(arm, as_span(below));
      const Eigen::Vector3d linear = (A.p - B.p) / (2 * h);
      const Eigen::Vector3d angular = rotation_log(A.R * B.R.transpose()) / (2 * h);
      EXPECT_LT((J.col(i).head<3>() - linear).norm(), 1e-8);
      EXPECT_LT((J.col(i).tail<3>() - angular).norm(), 1e-8);
    }
  }
}

TEST(Fk, AllThreePassesAgree) {
  Rng rng(12);
  for (int round = 0; round < 200; ++round) {
    const Arm arm = random_arm(1 + round % 16, rng);
    const JointVec q = random_q(arm, rng);
    const Pose X = fk(arm, as_span(q));
    std::vector<Pose> X_WJ(arm.joints.size());
    const Pose X_all = fk_all(arm, as_span(q), X_WJ);
    const FkJacobian both = fk_jacobian(arm, as_span(q));
    const Pose X_last = X_WJ.back() * arm.X_JT;
    for (const Pose& other : {X_all, both.X_WT, X_last}) {
      EXPECT_EQ(other.p, X.p);
      EXPECT_EQ(other.R, X.R);
    }
    EXPECT_LT((X.R.transpose() * X.R - Eigen::Matrix3d::Identity()).norm(), 1e-13);
  }
}

TEST(Fk, SingularValuesMatchEigen) {
  Rng rng(13);
  for (int round = 0; round < 300; ++round) {
    const Arm arm = random_arm(1 + round % 16, rng);
    const Jacobian J = fk_jacobian(arm, as_span(random_q(arm, rng))).J_W;
    const Eigen::VectorXd values = singular_values(J).values;
    const double product = values.prod();
    EXPECT_NEAR(smallest_singular_value(J), values.tail<1>()[0], 1e-13);
    EXPECT_NEAR(manipulability(J), product, 1e-12 * std::max(1.0, product));
  }
}

TEST(Fk, SingularConfigurationsHaveNoManipulability) {
  const std::vector<double> stretched{0.3, -0.5, 0, 0.2, 1.1, 0.4};  // elbow straight
  const std::vector<double> wrist{0.3, -0.5, 1.2, 0.2, 0, 0.4};      // axes 4 and 6 parallel
  for (const auto& q : {stretched, wrist}) {
    const Jacobian J = fk_jacobian(ur5e(), q).J_W;
    EXPECT_LT(manipulability(J), 1e-15);
    EXPECT_LT(smallest_singular_value(J), 1e-15);
  }
  const Jacobian fine = fk_jacobian(ur5e(), std::vector<double>{0.3, -1, 1.2, 0.2, 1, 0.4}).J_W;
  EXPECT_GT(manipulability(fine), 0.01);
}

TEST(Fk, LimitsAreCheckedAndClamped) {
  const Arm arm = panda();
  const JointVec home = arm.home;
  EXPECT_TRUE(within_limits(arm, as_span(home)));
  EXPECT_TRUE(within_limits(arm, as_span(arm.limits.upper)));
  EXPECT_FALSE(within_limits(arm, as_span(arm.limits.upper), 1e-3));
  JointVec bad = home;
  bad[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(within_limits(arm, as_span(bad)));
  EXPECT_FALSE(within_limits(arm, std::span(as_span(home)).first(6)));
  JointVec far = home;
  far[0] = 9;
  far[3] = -9;
  const JointVec inside = clamp_to_limits(arm, as_span(far));
  EXPECT_EQ(inside[0], arm.limits.upper[0]);
  EXPECT_EQ(inside[3], arm.limits.lower[3]);
  EXPECT_EQ(inside[1], home[1]);
}

}  // namespace
}  // namespace mjarm
