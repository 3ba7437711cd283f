#include "mjarm/trajectory/trajectory.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "mjarm/core/rng.hpp"
#include "tests/support/constants.hpp"

namespace mjarm {
namespace {

using support::kNaN;

JointVec random_vec(Rng& rng, Eigen::Index dof, double size) {
  JointVec v(dof);
  for (double& x : v) x = rng.uniform(-size, size);
  return v;
}

JointState rest(double q) { return JointState::at_rest(JointVec::Constant(1, q)); }

TEST(Trajectory, ReproducesQuintics) {
  Rng rng(1);
  for (int i = 0; i < 200; ++i) {
    const std::array<JointVec, 6> c{random_vec(rng, 3, 1), random_vec(rng, 3, 1),
                                    random_vec(rng, 3, 1), random_vec(rng, 3, 1),
                                    random_vec(rng, 3, 1), random_vec(rng, 3, 1)};
    const auto exact = [&](double t) {
      JointState x{JointVec::Zero(3), JointVec::Zero(3), JointVec::Zero(3)};
      for (int k = 0; k < 6; ++k) {
        const auto& ck = c[static_cast<std::size_t>(k)];
        x.q += ck * std::pow(t, k);
        if (k > 0) x.v += ck * (k * std::pow(t, k - 1));
        if (k > 1) x.a += ck * (k * (k - 1) * std::pow(t, k - 2));
      }
      return x;
    };
    const double t1 = rng.uniform(0.1, 1), t2 = t1 + rng.uniform(0.1, 1);
    const auto trajectory = Trajectory::through({0, t1, t2}, {exact(0), exact(t1), exact(t2)});
    ASSERT_TRUE(trajectory.has_value());
    EXPECT_EQ(trajectory->duration(), t2);
    EXPECT_EQ(trajectory->dof(), 3);
    for (int k = 0; k <= 10; ++k) {
      const double t = std::min(t2 * k / 10, t2);
      const JointState x = trajectory->at(t), y = exact(t);
      EXPECT_LT((x.q - y.q).cwiseAbs().maxCoeff(), 1e-11);
      EXPECT_LT((x.v - y.v).cwiseAbs().maxCoeff(), 1e-9);
      EXPECT_LT((x.a - y.a).cwiseAbs().maxCoeff(), 1e-8);
    }
  }
}

TEST(Trajectory, PhasesOfConstantJerkAreExactHoweverShort) {
  // Speeding up for 1 ns of jerk time, then one second at constant acceleration.
  const JointVec jerk = JointVec::Constant(1, 1e9), zero = JointVec::Zero(1);
  const double h = 1e-9;
  JointState end{JointVec::Constant(1, 3 + 0.5 + h * 1 / 6 * h + 0.5 * h), zero, zero};
  end.v[0] = 1 + 0.5 * h;
  end.a[0] = 1;
  const auto trajectory =
      Trajectory::from_jerks(rest(3), std::array{h, 0.0, 1.0}, std::array{jerk, jerk, zero}, end);
  ASSERT_TRUE(trajectory.has_value());
  EXPECT_NEAR(trajectory->at(0.5 * h).a[0], 0.5, 1e-9);
  EXPECT_NEAR(trajectory->at(0.5).a[0], 1, 1e-12);
  EXPECT_NEAR(trajectory->at(0.5).v[0], 0.5, 1e-9);
  EXPECT_NEAR(trajectory->at(0.999999).q[0], 3.499999, 1e-6);
}

TEST(Trajectory, HoldsItsEnds) {
  const auto move = Trajectory::through({0, 2}, {rest(1), rest(5)});
  ASSERT_TRUE(move.has_value());
  for (const double t : {-1.0, 0.0}) EXPECT_EQ(move->at(t).q[0], 1);
  for (const double t : {2.0, 9.0}) EXPECT_EQ(move->at(t).q[0], 5);
  EXPECT_EQ(move->at(3).v[0], 0);
  EXPECT_NEAR(move->at(1).q[0], 3, 1e-12);
  const auto still = Trajectory::through({0}, {rest(4)});
  ASSERT_TRUE(still.has_value());
  EXPECT_EQ(still->duration(), 0);
  EXPECT_EQ(still->at(0).q[0], 4);
  EXPECT_EQ(Trajectory().dof(), 0);
  EXPECT_EQ(Trajectory().duration(), 0);
}

TEST(Trajectory, RefusesBadKnots) {
  const JointState two{JointVec::Zero(2), JointVec::Zero(2), JointVec::Zero(2)};
  const JointState half{JointVec::Zero(2), JointVec::Zero(1), JointVec::Zero(2)};
  EXPECT_FALSE(Trajectory::through({}, {}).has_value());
  EXPECT_FALSE(Trajectory::through({0, 1}, {rest(0)}).has_value());
  EXPECT_FALSE(Trajectory::through({0.1, 1}, {rest(0), rest(1)}).has_value());
  EXPECT_FALSE(Trajectory::through({0, 0}, {rest(0), rest(1)}).has_value());
  EXPECT_FALSE(Trajectory::through({0, kNaN}, {rest(0), rest(1)}).has_value());
  EXPECT_FALSE(Trajectory::through({0, 1}, {rest(0), rest(kNaN)}).has_value());
  EXPECT_FALSE(Trajectory::through({0, 1}, {rest(0), two}).has_value());
  EXPECT_FALSE(Trajectory::through({0, 1}, {two, half}).has_value());
  const JointVec jerk = JointVec::Ones(1);
  const auto refused = [&](double h, const JointVec& j) {
    return !Trajectory::from_jerks(rest(0), std::array{h}, std::array{j}, rest(0)).has_value();
  };
  EXPECT_FALSE(refused(1, jerk));
  EXPECT_TRUE(refused(-1, jerk));
  EXPECT_TRUE(refused(kNaN, jerk));
  EXPECT_TRUE(refused(1, JointVec::Ones(2)));
  EXPECT_TRUE(refused(1, jerk * kNaN));
}

TEST(CheckLimits, MeasuresEveryUse) {
  // q = 3 t^5 over 1 s: worst at the end v = 15, a = 60, jerk = 180.
  JointState end = rest(3);
  end.v[0] = 15;
  end.a[0] = 60;
  const auto trajectory = Trajectory::through({0, 1}, {rest(0), end});
  ASSERT_TRUE(trajectory.has_value());
  const auto one = [](double x) { return JointVec(JointVec::Constant(1, x)); };
  const LimitUse use =
      check_limits(*trajectory, {one(-1), one(2.5), one(30), one(15), one(180), one(1), {}}, 1e-4);
  EXPECT_NEAR(use.velocity[0], 0.5, 1e-12);
  EXPECT_NEAR(use.acceleration[0], 4, 1e-12);
  EXPECT_NEAR(use.jerk[0], 1, 1e-3);
  EXPECT_NEAR(use.position[0], 0.5, 1e-12);
  EXPECT_NEAR(use.worst(), 4, 1e-12);
}

}  // namespace
}  // namespace mjarm
