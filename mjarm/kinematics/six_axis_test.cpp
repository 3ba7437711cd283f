#include "mjarm/kinematics/six_axis.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <iostream>

#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik_all.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"
#include "tests/support/constants.hpp"

namespace mjarm {
namespace {

using testing::make_arm;
using testing::random_q;
using testing::ur5e;

using support::kPi;

/// Poses an arm.
int rounds() {
#ifdef NDEBUG
  return testing::rounds(10000, 1000000);
#else
  return testing::rounds(1500, 1000000);
#endif
}

/// Six hinges with a spherical wrist, Puma-like; `offset` moves the shoulder off axis 1.
Arm spherical(double offset) {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const double half = kPi / 2;
  return make_arm("spherical",
                  {{{0, 0, 0.4}, {0, 0, 0}, z, -2.9, 2.9},
                   {{offset, 0, 0.1}, {-half, 0, 0}, z, -2.4, 1.2},
                   {{0.45, 0, 0.5 * offset}, {0, 0, 0}, z, -2.6, 1.3},
                   {{0.04, -0.43, 0}, {half, 0, 0}, z, -3.4, 3.4},
                   {{0, 0, 0}, {-half, 0, 0}, z, -2, 2},
                   {{0, 0, 0}, {half, 0, 0}, z, -6, 6}},
                  {{0.02, 0, 0.08}, from_euler({0.1, -0.2, 0.3})});
}

/// An arm of one of the two forms with random lengths, tilts, frames and limits.
Arm random_six(bool parallel, Rng& rng) {
  const auto number = [&](double size) { return rng.uniform(-size, size); };
  const auto vec = [&](double size) {
    return Eigen::Vector3d(number(size), number(size), number(size));
  };
  const auto flip = [&] { return rng.uniform() < 0.5 ? -1.0 : 1.0; };
  // Axes as lines in the world at q = 0.
  std::vector<Eigen::Vector3d> p(6), h(6);
  h[0] = (Eigen::Vector3d::UnitZ() + vec(0.3)).normalized();
  h[1] = (Eigen::Vector3d::UnitY() + vec(0.3)).normalized();
  h[2] = flip() * h[1];
  h[3] = parallel ? Eigen::Vector3d(flip() * h[1]) : vec(1).normalized();
  p[0] = vec(0.2);
  for (std::size_t i = 1; i < 4; ++i) p[i] = p[i - 1] + vec(0.4);
  const Eigen::Vector3d p_C = p[3] + (parallel ? vec(0.2) : Eigen::Vector3d(0.2 * h[3]));
  const auto bent = [&](const Eigen::Vector3d& from) {  // nearly at right angles, like real wrists
    return (from.unitOrthogonal() + vec(0.15)).normalized();
  };
  h[4] = bent(h[3]);
  h[5] = bent(h[4]);
  p[4] = p_C + number(0.1) * h[4];
  p[5] = p_C + number(0.1) * h[5];
  std::vector<testing::JointRow> rows;
  Pose X_WP;
  for (std::size_t i = 0; i < 6; ++i) {
    const Eigen::Vector3d rpy = vec(3);
    const Eigen::Matrix3d R_WJ = from_euler(rpy);
    const Eigen::Matrix3d R_PJ = X_WP.R.transpose() * R_WJ;
    const double half = rng.uniform(1, 6.5);
    rows.push_back({X_WP.R.transpose() * (p[i] - X_WP.p),
                    {0, 0, 0},
                    R_WJ.transpose() * h[i],
                    -half + number(0.5),
                    half});
    rows.back().rpy = to_euler(R_PJ);
    X_WP = {p[i], R_WJ};
  }
  return make_arm("random six", rows, {vec(0.2), from_euler(vec(3))});
}

/// `arm` with every joint frame turned by `angle` and moved by `place` in a random direction.
Arm calibrated(Arm arm, double angle, double place, Rng& rng) {
  const auto unit = [&] {
    return Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
  };
  for (ArmJoint& joint : arm.joints) {
    joint.X_PJ.R = joint.X_PJ.R * rotation_exp(angle * unit());
    joint.X_PJ.p += place * unit();
  }
  return arm;
}

double largest_off(const JointVec& a, const JointVec& b, bool modulo_turns) {
  double out = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    const double d = a[i] - b[i];
    out = std::max(out, std::abs(modulo_turns ? std::remainder(d, 2 * kPi) : d));
  }
  return out;
}

void expect_reaches(const Arm& arm, const IkSolution& answer, const Pose& X_goal, double tol) {
  const Pose X = fk(arm, as_span(answer.q));
  EXPECT_LT((X.p - X_goal.p).norm(), tol);
  EXPECT_LT(angle_between(X.R, X_goal.R), tol);
  EXPECT_TRUE(within_limits(arm, as_span(answer.q)));
}

/// Solves for poses of random configurations changed by `shape`; all must be solved (with an exact
/// form; else all but one in ten thousand), to `fine` but for one in a hundred thousand, which may
/// lie so near to a singularity that it is less exact.
void expect_all_solved(
    const Arm& arm, int count, double fine, Rng& rng,
    const std::function<void(JointVec&)>& shape = [](JointVec&) {}) {
  const IkSolver ik(arm);
  ASSERT_TRUE(ik.six_axis().has_value());
  int coarse = 0, missed = 0;
  for (int i = 0; i < count; ++i) {
    JointVec q = random_q(arm, rng);
    shape(q);
    q = clamp_to_limits(arm, as_span(q));
    const Pose X_goal = fk(arm, as_span(q));
    const auto answer = ik.solve(X_goal, as_span(random_q(arm, rng)));
    if (!answer) {
      ++missed;
      std::cout << arm.name << ": " << describe(answer.error(), arm) << " at\n"
                << q.transpose() << '\n';
      continue;
    }
    expect_reaches(arm, *answer, X_goal, 1.01e-7);
    coarse += std::max(answer->pos_err, answer->rot_err) > fine ? 1 : 0;
  }
  EXPECT_LE(coarse, count / 100000);
  EXPECT_LE(missed, ik.six_axis()->is_exact() ? 0 : count / 10000);
}

TEST(SixAxis, IsRecognisedByGeometry) {
  EXPECT_TRUE(SixAxis::recognise(Chain(ur5e()))->is_parallel());
  EXPECT_TRUE(SixAxis::recognise(Chain(ur5e(true)))->is_exact());
  EXPECT_FALSE(SixAxis::recognise(Chain(spherical(0.1)))->is_parallel());
  EXPECT_FALSE(SixAxis::recognise(Chain(testing::panda())).has_value());
  Rng rng(71);
  for (int i = 0; i < 200; ++i) {
    const bool parallel = i % 2 == 0;
    const auto form = SixAxis::recognise(Chain(random_six(parallel, rng)));
    ASSERT_TRUE(form.has_value());
    EXPECT_EQ(form->is_parallel(), parallel);
    EXPECT_LT(form->defect(), 1e-12);
    EXPECT_FALSE(SixAxis::recognise(Chain(testing::random_arm(6, rng))).has_value());
  }
}

TEST(SixAxis, SolvesEveryPoseOfKnownArms) {
  Rng rng(72);
  for (const Arm& arm : {ur5e(), ur5e(true), spherical(0), spherical(0.12)}) {
    expect_all_solved(arm, rounds(), 1.01e-10, rng);
  }
}

TEST(SixAxis, SolvesEveryPoseOfRandomArms) {
  Rng rng(73);
  for (int i = 0; i < 100; ++i) {
    expect_all_solved(random_six(i % 2 == 0, rng), rounds() / 100, 1e-9, rng);
  }
}

TEST(SixAxis, SolvesSingularPoses) {
  Rng rng(74);
  const auto tiny = [&] { return std::pow(10.0, rng.uniform(-14, -3)) * (rng.uniform() - 0.5); };
  const int count = rounds() / 10;
  for (const Arm& arm : {ur5e(), spherical(0), spherical(0.12)}) {
    const double wrist[] = {0, kPi, -kPi};
    for (const double q5 : wrist) {
      expect_all_solved(arm, count, 1.01e-7, rng, [&](JointVec& q) { q[4] = q5; });
      expect_all_solved(arm, count, 1.01e-7, rng, [&](JointVec& q) { q[4] = q5 + tiny(); });
    }
    const double straight = arm.dof() == 6 && arm.name == "ur5e" ? 0 : std::atan2(-0.43, 0.04);
    for (const double q3 : {straight, straight + kPi, 0.0}) {
      expect_all_solved(arm, count, 1.01e-7, rng, [&](JointVec& q) { q[2] = q3; });
      expect_all_solved(arm, count, 1.01e-7, rng, [&](JointVec& q) { q[2] = q3 + tiny(); });
      expect_all_solved(arm, count, 1.01e-7, rng, [&](JointVec& q) {
        q[2] = q3;
        q[4] = 0;
      });
    }
    expect_all_solved(arm, count, 1.01e-7, rng, [&](JointVec& q) {  // quarters of a turn
      for (int i = 0; i < 6; ++i) q[i] = kPi / 2 * std::round(q[i] / (kPi / 2));
    });
  }
}

/// The wrist centre on the plane through axis 1 where both shoulder branches meet: q2 is found so
/// that the Jacobian loses rank there.
TEST(SixAxis, SolvesPosesOnTheShoulderCylinder) {
  const Arm arm = ur5e();
  Rng rng(75);
  int on_it = 0;
  for (int i = 0; i < 2000; ++i) {
    JointVec q = random_q(arm, rng);
    // Radius of the wrist centre: 0.425 sin q2 + 0.392 sin(q2 + q3) + 0.1 along the axis of
    // joint 5.
    const double lift = rng.uniform(-kPi, kPi);  // q2 + q3
    const double sum = rng.uniform(-kPi, kPi);   // q2 + q3 + q4
    std::vector<Pose> X_WJ(6);
    const double rest = 0.392 * std::sin(lift + kPi / 2) + 0.1 * std::sin(sum + kPi);
    if (std::abs(rest) > 0.42) continue;
    q[1] = std::asin(-rest / 0.425) - kPi / 2;
    q[2] = std::remainder(lift - q[1], 2 * kPi);
    q[3] = sum - q[1] - q[2];
    const Pose X_goal = fk_all(arm, as_span(clamp_to_limits(arm, as_span(q))), X_WJ);
    const auto answer = IkSolver(arm).solve(X_goal, as_span(random_q(arm, rng)));
    ASSERT_TRUE(answer.has_value()) << describe(answer.error(), arm);
    expect_reaches(arm, *answer, X_goal, 1.01e-7);
    on_it += X_WJ[5].p.head<2>().norm() < 0.134 + 1e-9 ? 1 : 0;
  }
  EXPECT_GT(on_it, 300);
}

TEST(SixAxis, TheGeneratingConfigurationIsAmongAll) {
  Rng rng(76);
  for (const Arm& arm : {ur5e(), spherical(0.12)}) {
    const IkSolver ik(arm);
    int merged = 0;  // with a branch so near that both count as one
    for (int i = 0; i < rounds() / 5; ++i) {
      const JointVec q = random_q(arm, rng);
      const Pose X_goal = fk(arm, as_span(q));
      const auto all = solve_all(ik, X_goal, as_span(random_q(arm, rng)));
      ASSERT_TRUE(all.has_value());
      EXPECT_LE(all->size(), 8U);
      double off = kPi;
      for (const IkSolution& answer : *all) off = std::min(off, largest_off(answer.q, q, true));
      EXPECT_LT(off, IkAllOptions().same) << q.transpose();
      merged += off < 1e-6 ? 0 : 1;
      for (std::size_t k = 0; k < all->size(); ++k) {
        expect_reaches(arm, (*all)[k], X_goal, 1.01e-7);
        for (std::size_t j = 0; j < k; ++j) {
          EXPECT_GE(largest_off((*all)[k].q, (*all)[j].q, false), 1e-3);
        }
      }
      const auto nearest = ik.solve(X_goal, as_span(q));  // q itself, or a branch that is as near
      ASSERT_TRUE(nearest.has_value());
      EXPECT_LT(largest_off(nearest->q, q, false), 1e-6);
    }
    EXPECT_LE(merged, rounds() / 5 / 1000);
  }
}

TEST(SixAxis, WindingsAreAllThere) {
  const Arm arm = ur5e();
  const IkSolver ik(arm);
  Rng rng(77);
  std::size_t max = 0;
  for (int i = 0; i < 200; ++i) {
    const JointVec q = random_q(arm, rng);
    const JointVec seed = random_q(arm, rng);
    const Pose X_goal = fk(arm, as_span(q));
    const auto few = solve_all(ik, X_goal, as_span(seed));
    const auto many = solve_all(ik, X_goal, as_span(seed), {.windings = true});
    ASSERT_TRUE(few && many);
    EXPECT_EQ(many->size(), 32 * few->size());  // five joints of two turns
    max = std::max(max, many->size());
    EXPECT_EQ((*many)[0].q, (*few)[0].q);
    double before = 0;
    bool found = false;
    for (const IkSolution& answer : *many) {
      EXPECT_TRUE(within_limits(arm, as_span(answer.q)));
      EXPECT_GE(largest_off(answer.q, seed, false), before);
      before = largest_off(answer.q, seed, false);
      found = found || largest_off(answer.q, q, false) < 1e-6;
    }
    expect_reaches(arm, many->back(), X_goal, 1.01e-7);
    EXPECT_TRUE(found);
    EXPECT_EQ(solve_all(ik, X_goal, as_span(seed), {.windings = true, .max = 7})->size(), 7U);
  }
  EXPECT_EQ(max, 256U);
}

TEST(SixAxis, ACalibratedArmIsSolvedEveryTime) {
  Rng rng(78);
  for (int i = 0; i < 20; ++i) {
    const Arm arm = calibrated(i % 2 == 0 ? ur5e() : spherical(0.1), 5e-3, i < 10 ? 0 : 2e-3, rng);
    const auto form = SixAxis::recognise(Chain(arm));
    ASSERT_TRUE(form.has_value());
    EXPECT_FALSE(form->is_exact());
    expect_all_solved(arm, rounds() / 20, 1.01e-7, rng);
  }
}

TEST(SixAxis, RoundedFiguresAreSolvedAndNoProof) {
  Rng rng(79);
  Arm arm = ur5e();
  for (ArmJoint& joint : arm.joints) {  // as if half pi stood in the file with six digits
    joint.X_PJ.R = joint.X_PJ.R * rotation_exp(Eigen::Vector3d(7e-7, -5e-7, 6e-7));
  }
  EXPECT_FALSE(SixAxis::recognise(Chain(arm))->is_exact());
  expect_all_solved(arm, 500, 1.01e-7, rng);
}

TEST(SixAxis, SameInputsSameBits) {
  Rng rng(80);
  const Arm arm = ur5e();
  const IkSolver ik(arm);
  const IkSolver copy = ik;
  for (int i = 0; i < 500; ++i) {
    const Pose X_goal = fk(arm, as_span(random_q(arm, rng)));
    const JointVec seed = random_q(arm, rng);
    EXPECT_EQ(ik.solve(X_goal, as_span(seed))->q, copy.solve(X_goal, as_span(seed))->q);
  }
}

TEST(SixAxis, AStepBoundGivesNoneRatherThanAFlip) {
  Rng rng(81);
  const Arm arm = ur5e();
  const IkSolver free(arm);
  IkOptions options;
  options.max_step = 0.5;
  const IkSolver bound(arm, options);
  int none = 0;
  for (int i = 0; i < 2000; ++i) {
    const Pose X_goal = fk(arm, as_span(random_q(arm, rng)));
    JointVec seed = random_q(arm, rng);
    if (i % 2 == 0) seed = free.solve(X_goal, as_span(seed))->q + JointVec::Constant(6, 0.3);
    seed = clamp_to_limits(arm, as_span(seed));
    const auto nearest = free.solve(X_goal, as_span(seed));
    const auto answer = bound.solve(X_goal, as_span(seed));
    ASSERT_TRUE(nearest.has_value());
    const double step = largest_off(nearest->q, seed, false);
    ASSERT_EQ(answer.has_value(), step <= 0.5);
    if (answer) {
      EXPECT_EQ(answer->q, nearest->q);
    } else {
      ++none;
      EXPECT_EQ(answer.error().code, IkErrc::too_far);
      EXPECT_NEAR(answer.error().amount, step - 0.5, 1e-9);
      EXPECT_NE(describe(answer.error(), arm).find("joint"), std::string::npos);
    }
  }
  EXPECT_GT(none, 500);
}

TEST(SixAxis, ThePredicateSeesBranchesInOrderOfNearness) {
  Rng rng(82);
  const Arm arm = ur5e();
  for (int i = 0; i < 200; ++i) {
    const Pose X_goal = fk(arm, as_span(random_q(arm, rng)));
    const JointVec seed = random_q(arm, rng);
    const auto all = solve_all(IkSolver(arm), X_goal, as_span(seed));
    std::vector<JointVec> seen;
    IkOptions options;
    options.valid = [&](std::span<const double> q) {
      seen.push_back(joint_vec(q));
      return seen.size() == all->size();
    };
    const auto last = IkSolver(arm, options).solve(X_goal, as_span(seed));
    ASSERT_TRUE(last.has_value());
    ASSERT_EQ(seen.size(), all->size());
    for (std::size_t k = 0; k < seen.size(); ++k) EXPECT_EQ(seen[k], (*all)[k].q);
    EXPECT_EQ(last->q, all->back().q);
  }
}

}  // namespace
}  // namespace mjarm
