#include <gtest/gtest.h>

#include <cmath>

#include "mjarm/core/rng.hpp"
#include "mjarm/trajectory/limits_test.hpp"
#include "mjarm/trajectory/trajectory.hpp"
#include "tests/support/constants.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm {
namespace {

using testing::limits_of;

using support::kNaN;

JointLimits one_joint(double v, double a, double j) {
  return limits_of(JointVec::Constant(1, v), JointVec::Constant(1, a), JointVec::Constant(1, j));
}

struct Case {
  JointVec q0, q1;
  JointLimits limits;
};

Case random_case(Rng& rng) {
  const auto dof = static_cast<Eigen::Index>(1 + rng.below(8));
  Case c{JointVec(dof), JointVec(dof), limits_of(JointVec(dof), JointVec(dof), JointVec(dof))};
  const double size = std::pow(10, rng.uniform(-9, 0.8));  // from nanoradians to turns
  for (Eigen::Index i = 0; i < dof; ++i) {
    c.q0[i] = rng.uniform(-3, 3);
    c.q1[i] = rng.uniform() < 0.2 ? c.q0[i] : c.q0[i] + rng.uniform(-size, size);
    c.limits.velocity[i] = std::pow(10, rng.uniform(-1, 1));
    c.limits.acceleration[i] = std::pow(10, rng.uniform(-1, 2));
    c.limits.jerk[i] = std::pow(10, rng.uniform(0, 4));
  }
  return c;
}

TEST(JointMove, KeepsItsPromisesOnRandomMoves) {
  Rng rng(1);
  for (int i = 0; i < 3000; ++i) {
    const Case c = random_case(rng);
    const auto move = time_joint_move(as_span(c.q0), as_span(c.q1), c.limits);
    ASSERT_TRUE(move.has_value()) << move.error().what;
    const double T = move->duration();
    EXPECT_EQ(move->at(0).q, c.q0);
    EXPECT_EQ(move->at(T).q, c.q1);
    for (const double t : {0.0, T}) {
      EXPECT_EQ(move->at(t).v.norm(), 0);
      EXPECT_EQ(move->at(t).a.norm(), 0);
    }
    const JointVec way = c.q1 - c.q0;
    JointState before = move->at(0);
    constexpr int kSamples = 101;  // no multiple of the phases
    for (int k = 1; k <= kSamples && T > 0; ++k) {
      const double h = T / kSamples;
      const JointState x = move->at(k * h);
      EXPECT_LE(x.v.cwiseAbs().cwiseQuotient(c.limits.velocity).maxCoeff(), 1 + 1e-6);
      EXPECT_LE(x.a.cwiseAbs().cwiseQuotient(c.limits.acceleration).maxCoeff(), 1 + 1e-6);
      const JointVec jerk = (x.a - before.a) / h;
      EXPECT_LE(jerk.cwiseAbs().cwiseQuotient(c.limits.jerk).maxCoeff(), 1 + 1e-6);
      // Straight in joint space: every joint has done the same share of its way.
      const double share = way.dot(x.q - c.q0) / way.squaredNorm();
      EXPECT_LT((x.q - c.q0 - share * way).norm(), 1e-13);
      before = x;
    }
  }
}

TEST(JointMove, DerivativesAgreeWithDifferences) {
  Rng rng(2);
  for (int i = 0; i < 300; ++i) {
    Case c = random_case(rng);
    for (double& q : c.q1) q += rng.uniform(0.1, 1);
    const auto move = time_joint_move(as_span(c.q0), as_span(c.q1), c.limits);
    ASSERT_TRUE(move.has_value());
    const double T = move->duration(), h = 1e-5 * T;
    for (int k = 0; k < 20; ++k) {
      const double t = rng.uniform(h, T - h);
      const JointState x = move->at(t), low = move->at(t - h), high = move->at(t + h);
      const JointVec jerk = c.limits.jerk;
      EXPECT_LT(((high.q - low.q) / (2 * h) - x.v).cwiseAbs().maxCoeff(),
                h * h * jerk.maxCoeff() + 1e-9);
      EXPECT_LT(((high.v - low.v) / (2 * h) - x.a).cwiseAbs().maxCoeff(),
                h * jerk.maxCoeff() + 1e-7);
    }
  }
}

TEST(JointMove, DurationIsTheClosedForm) {
  const auto duration = [](double way, double v, double a, double j) {
    const std::vector<double> q0{1}, q1{1 + way};
    return time_joint_move(q0, q1, one_joint(v, a, j))->duration();
  };
  EXPECT_NEAR(duration(2, 1, 2, 10), 2 / 1. + 1 / 2. + 2 / 10., 1e-12);        // all seven phases
  EXPECT_NEAR(duration(-2, 1, 2, 10), 2 / 1. + 1 / 2. + 2 / 10., 1e-12);       // backward
  EXPECT_NEAR(duration(2, 1, 100, 4), 2 / 1. + 2 * std::sqrt(1 / 4.), 1e-12);  // no steady accel
  EXPECT_NEAR(duration(0.01, 9, 9, 4), 4 * std::cbrt(0.01 / 8), 1e-12);        // jerk alone
  const double t = 2 / 10.;  // acceleration limit met, speed limit not
  EXPECT_NEAR(duration(0.3, 9, 2, 10), t + std::sqrt(t * t + 4 * 0.3 / 2), 1e-12);
}

TEST(JointMove, IsNeverShorterThanEachJointAlone) {
  Rng rng(3);
  for (int i = 0; i < 1000; ++i) {
    const Case c = random_case(rng);
    const double T = time_joint_move(as_span(c.q0), as_span(c.q1), c.limits)->duration();
    for (Eigen::Index j = 0; j < c.q0.size(); ++j) {
      const std::vector<double> q0{c.q0[j]}, q1{c.q1[j]};
      const double alone =
          time_joint_move(
              q0, q1, one_joint(c.limits.velocity[j], c.limits.acceleration[j], c.limits.jerk[j]))
              ->duration();
      EXPECT_GE(T, alone * (1 - 1e-12));
      EXPECT_GE(T, std::abs(q1[0] - q0[0]) / c.limits.velocity[j]);
    }
  }
}

TEST(JointMove, ShareLowersSpeedAndAcceleration) {
  const std::vector<double> q0{0}, q1{2};
  const auto move = time_joint_move(q0, q1, one_joint(1, 2, 100), {.joint_share = 0.5});
  ASSERT_TRUE(move.has_value());
  EXPECT_NEAR(move->duration(), 2 / 0.5 + 0.5 / 1 + 1 / 100., 1e-12);
}

TEST(JointMove, StandingStillTakesNoTime) {
  const std::vector<double> q{1, 2};
  const auto move =
      time_joint_move(q, q, limits_of(JointVec::Ones(2), JointVec::Ones(2), JointVec::Ones(2)));
  ASSERT_TRUE(move.has_value());
  EXPECT_EQ(move->duration(), 0);
  EXPECT_EQ(move->at(0).q, joint_vec(q));
}

TEST(JointMove, RefusesBadInput) {
  const std::vector<double> one{1}, two{1, 2}, none, broken{kNaN};
  const JointLimits good = one_joint(1, 1, 1);
  EXPECT_FALSE(time_joint_move(none, none, good).has_value());
  EXPECT_FALSE(time_joint_move(one, two, good).has_value());
  EXPECT_FALSE(time_joint_move(one, broken, good).has_value());
  EXPECT_FALSE(time_joint_move(two, two, good).has_value());
  EXPECT_FALSE(time_joint_move(std::vector<double>(17), std::vector<double>(17), good).has_value());
  EXPECT_FALSE(time_joint_move(one, one, one_joint(0, 1, 1)).has_value());
  EXPECT_FALSE(time_joint_move(one, one, one_joint(1, -1, 1)).has_value());
  EXPECT_FALSE(time_joint_move(one, one, one_joint(1, 1, kNaN)).has_value());
  EXPECT_FALSE(time_joint_move(one, one, good, {.joint_share = 0}).has_value());
  EXPECT_FALSE(time_joint_move(one, one, good, {.joint_share = 1.1}).has_value());
  const auto share = time_joint_move(one, one, good, {.joint_share = 2});
  EXPECT_NE(share.error().what.find("is 2"), std::string::npos) << share.error().what;
}

void expect_best_known(const std::string& name, bool equal) {
  MJARM_TEST_FILE(file, "trajectory_cases/" + name + ".json");
  MJARM_TEST_FILE(best_file, "trajectory_cases/best_known.json");
  const nlohmann::json data = support::load_json(file);
  const nlohmann::json best = support::load_json(best_file).at(name).at("p2p_vaj");
  const auto vec = [](const nlohmann::json& v) { return joint_vec(v.get<std::vector<double>>()); };
  const nlohmann::json& l = data.at("limits");
  const JointLimits limits = limits_of(vec(l.at("v")), vec(l.at("a")), vec(l.at("j")));
  int count = 0;
  double worst = 0;
  for (const auto& entry : data.at("cases")) {
    if (entry.at("kind") != "rest") continue;
    const JointVec q0 = vec(entry.at("q0")), q1 = vec(entry.at("q1"));
    const auto move = time_joint_move(as_span(q0), as_span(q1), limits);
    ASSERT_TRUE(move.has_value());
    const double optimum = best.at(std::to_string(entry.at("id").get<int>())).get<double>();
    // The figures are rounded to 9 digits after the point.
    EXPECT_GE(move->duration(), optimum - 6e-10);
    const double above = equal ? 6e-10 : 10;
    EXPECT_LE(move->duration(), optimum + above);
    worst = std::max(worst, move->duration() / optimum - 1);
    ++count;
  }
  EXPECT_GT(count, 100);
  ::testing::Test::RecordProperty("worst_over_optimum", std::to_string(worst));
}

// All joints of the UR5e have the same limits, so the straight line is as fast as any other way.
TEST(JointMoveData, Ur5eIsOptimal) { expect_best_known("ur5e_p2p", true); }
TEST(JointMoveData, PandaIsNotFasterThanTheOptimum) { expect_best_known("panda_p2p", false); }

}  // namespace
}  // namespace mjarm
