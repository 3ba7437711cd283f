#include "mjarm/kinematics/ik.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "mjarm/core/messages.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/compare_test.hpp"
#include "mjarm/kinematics/count_solved_test.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {
namespace {

using testing::count_solved;
using testing::panda;
using testing::random_arm;
using testing::random_q;
using testing::ur5e;

#ifdef NDEBUG
constexpr int kRounds = 20000;
#else
constexpr int kRounds = 2000;
#endif

TEST(Ik, SolvesRandomPosesOfTheUr5e) {
  Rng rng(31);
  EXPECT_EQ(count_solved(ur5e(), IkSolver(ur5e()), kRounds, rng), kRounds);
}

TEST(Ik, TheNumericSearchSolvesThemToo) {
  Rng rng(31);
  EXPECT_EQ(count_solved(ur5e(), IkSolver(ur5e(), {.closed_form = false}), kRounds / 4, rng),
            kRounds / 4);
}

TEST(Ik, SolvesRandomPosesOfThePanda) {
  Rng rng(32);
  EXPECT_EQ(count_solved(panda(), IkSolver(panda()), kRounds, rng), kRounds);
}

TEST(Ik, SolvesRandomPosesOfRandomArms) {
  Rng rng(33);
  int solved = 0;
  for (int round = 0; round < 150; ++round) {
    const Arm arm = random_arm(1 + round % 10, rng);
    solved += count_solved(arm, IkSolver(arm), 10, rng);
  }
  EXPECT_GT(solved, 1470);  // strange arms with tight limits may need more restarts
}

TEST(Ik, SeedAtTheAnswerIsKept) {
  Rng rng(34);
  for (const Arm& arm : {ur5e(), panda()}) {
    const IkSolver ik(arm);
    for (int i = 0; i < 500; ++i) {
      const JointVec q = random_q(arm, rng);
      const auto answer = ik.solve(fk(arm, as_span(q)), as_span(q));
      ASSERT_TRUE(answer.has_value());
      EXPECT_EQ(answer->restarts, 0);
      EXPECT_LT((answer->q - q).cwiseAbs().maxCoeff(), 1e-9);
    }
  }
}

TEST(Ik, TakesTheWindingNearestToTheSeed) {
  constexpr double turn = 2 * std::numbers::pi;
  const Arm arm = ur5e();
  const IkSolver ik(arm);
  Rng rng(35);
  for (int i = 0; i < 2000; ++i) {
    const JointVec seed = random_q(arm, rng);
    const auto answer = ik.solve(fk(arm, as_span(random_q(arm, rng))), as_span(seed));
    ASSERT_TRUE(answer.has_value());
    for (int j = 0; j < 6; ++j) {
      for (const double other : {answer->q[j] - turn, answer->q[j] + turn}) {
        if (other < arm.limits.lower[j] || other > arm.limits.upper[j]) continue;
        EXPECT_GE(std::abs(other - seed[j]), std::abs(answer->q[j] - seed[j]) - 1e-12);
      }
    }
  }
}

TEST(Ik, SameSeedSameBits) {
  Rng rng(36);
  const IkSolver ik(panda());
  const IkSolver copy = ik;
  for (int i = 0; i < 300; ++i) {
    const Pose X_goal = fk(panda(), as_span(random_q(panda(), rng)));
    const JointVec seed = random_q(panda(), rng);
    const auto a = ik.solve(X_goal, as_span(seed));
    const auto b = ik.solve(X_goal, as_span(seed));
    const auto c = copy.solve(X_goal, as_span(seed));
    const auto d = IkSolver(panda()).solve(X_goal, as_span(seed));
    ASSERT_TRUE(a && b && c && d);
    EXPECT_TRUE(testing::same_bits(a->q, b->q) && testing::same_bits(a->q, c->q) &&
                testing::same_bits(a->q, d->q));
    EXPECT_EQ(a->iterations, b->iterations);
  }
}

TEST(Ik, OtherRngSeedOtherRestarts) {
  const IkSolver ik(panda(), {.closed_form = false});
  const IkSolver other(panda(), {.seed = 99, .closed_form = false});
  Rng rng(37);
  int differ = 0;
  for (int i = 0; i < 200; ++i) {
    const Pose X_goal = fk(panda(), as_span(random_q(panda(), rng)));
    const JointVec seed = random_q(panda(), rng);
    const auto a = ik.solve(X_goal, as_span(seed));
    const auto b = other.solve(X_goal, as_span(seed));
    ASSERT_TRUE(a && b);
    if (a->restarts > 0 && !testing::same_bits(a->q, b->q)) ++differ;
  }
  EXPECT_GT(differ, 20);
}

/// A three-joint arm reaches only a surface of poses; given one of them it must find it.
TEST(Ik, ThreeJointsReachWhatTheyCan) {
  const Arm arm = testing::make_arm("three",
                                    {{{0, 0, 0.1}, {0, 0, 0}, {0, 0, 1}, -3, 3},
                                     {{0, 0, 0.1}, {0, 0, 0}, {0, 1, 0}, -2, 2},
                                     {{0, 0, 0.4}, {0, 0, 0}, {0, 1, 0}, -2.5, 2.5}},
                                    {{0, 0, 0.3}, Eigen::Matrix3d::Identity()});
  Rng rng(38);
  EXPECT_EQ(count_solved(arm, IkSolver(arm), 500, rng), 500);
  Pose off = fk(arm, std::vector<double>{0.3, 0.5, 0.7});
  off.R = off.R * from_euler({0, 0, 0.4});  // about its own length: no joint can
  const auto answer = IkSolver(arm).solve(off, as_span(arm.home));
  ASSERT_FALSE(answer.has_value());
  EXPECT_EQ(answer.error().code, IkErrc::no_convergence);
}

TEST(Ik, SlidesAreSolved) {
  const Arm arm = testing::make_arm("gantry",
                                    {{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, -1, 1, JointType::slide},
                                     {{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, -1, 1, JointType::slide},
                                     {{0, 0, 0}, {0, 0, 0}, {0, 0, 1}, -1, 1, JointType::slide},
                                     {{0, 0, 0}, {0, 0, 0}, {0, 0, 1}, -3, 3}},
                                    {{0, 0, -0.2}, Eigen::Matrix3d::Identity()});
  const Pose X_goal{{0.4, -0.7, 0.3}, from_euler({0, 0, 1.2})};
  const auto answer = IkSolver(arm).solve(X_goal, as_span(arm.home));
  ASSERT_TRUE(answer.has_value());
  EXPECT_LT((answer->q - JointVec(Eigen::Vector4d(0.4, -0.7, 0.5, 1.2))).norm(), 1e-6);
}

TEST(Ik, JointsWithoutStopsAreSolved) {
  const double inf = std::numeric_limits<double>::infinity();
  Arm arm = ur5e();
  arm.limits.lower.setConstant(-inf);
  arm.limits.upper.setConstant(inf);
  Rng rng(39);
  EXPECT_EQ(count_solved(arm, IkSolver(arm), 300, rng), 300);
  const JointVec seed = JointVec::Constant(6, 40);
  const auto answer = IkSolver(arm).solve(fk(arm, as_span(random_q(arm, rng))), as_span(seed));
  ASSERT_TRUE(answer.has_value());
  EXPECT_LT((answer->q - seed).cwiseAbs().maxCoeff(), std::numbers::pi + 1e-9);
}

TEST(IkFailure, JointLimitIsNamed) {
  const auto arm_with = [](double limit) {
    return testing::make_arm("two",
                             {{{0, 0, 0}, {0, 0, 0}, {0, 0, 1}, -limit, limit},
                              {{0.5, 0, 0}, {0, 0, 0}, {0, 0, 1}, -3, 3}},
                             {{0.5, 0, 0}, Eigen::Matrix3d::Identity()});
  };
  const Pose X_goal = fk(arm_with(3), std::vector<double>{1.3, 0.4});
  const Arm arm = arm_with(1);
  const auto answer = IkSolver(arm).solve(X_goal, as_span(arm.home));
  ASSERT_FALSE(answer.has_value());
  EXPECT_EQ(answer.error().code, IkErrc::joint_limit);
  EXPECT_EQ(answer.error().joint, 0);
  EXPECT_NEAR(answer.error().amount, 0.3, 1e-6);
  EXPECT_TRUE(within_limits(arm, as_span(answer.error().best.q)));
  EXPECT_NE(describe(answer.error(), arm).find("joint1"), std::string::npos);
}

TEST(IkFailure, OutOfReachSaysHowFar) {
  const Arm arm = ur5e();
  const auto answer =
      IkSolver(arm).solve({{2, 0, 0.263}, Eigen::Matrix3d::Identity()}, as_span(arm.home));
  ASSERT_FALSE(answer.has_value());
  const IkFailure& failure = answer.error();
  EXPECT_EQ(failure.code, IkErrc::out_of_reach);
  EXPECT_NEAR(failure.amount, 2 - failure.bound, 1e-6);
  EXPECT_TRUE(within_limits(arm, as_span(failure.best.q)));
  // The best attempt is stretched towards the goal.
  EXPECT_LT(failure.best.pos_err, 1.3);
  EXPECT_EQ(failure.best.restarts, 0);
  set_language(Language::english);
  EXPECT_EQ(describe(failure, arm),
            "out of reach: 1.073 m farther than the arm can stretch (0.927 m from the shoulder)");
}

TEST(IkFailure, InnerVoidNamesTheCylinder) {
  const Arm arm = ur5e();
  const auto answer =
      IkSolver(arm).solve({{0.1, 0.05, 0.7}, Eigen::Matrix3d::Identity()}, as_span(arm.home));
  ASSERT_FALSE(answer.has_value());
  EXPECT_EQ(answer.error().code, IkErrc::inner_void);
  EXPECT_NEAR(answer.error().bound, 0.134, 1e-8);
  set_language(Language::english);
  EXPECT_EQ(describe(answer.error(), arm),
            "inside the 0.134 m cylinder round the base axis by 0.022 m");
  set_language(Language::chinese);
  EXPECT_NE(describe(answer.error(), arm).find("圆柱"), std::string::npos);
  set_language(Language::english);
}

TEST(IkFailure, BadInputIsRefused) {
  const Arm arm = ur5e();
  const IkSolver ik(arm);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Pose good = fk(arm, std::vector<double>{0.1, -1, 1, 0.4, 1, 0});
  const JointVec seed = JointVec::Zero(6);
  const auto code = [](const auto& answer) {
    return answer ? IkErrc::no_convergence : answer.error().code;
  };
  const auto with = [](double pos_tol, double rot_tol, int restarts) {
    IkOptions options;
    options.pos_tol = pos_tol;
    options.rot_tol = rot_tol;
    options.restarts = restarts;
    return options;
  };
  ASSERT_TRUE(ik.solve(good, as_span(seed)).has_value());
  Pose bad = good;
  bad.p.y() = nan;
  EXPECT_EQ(code(ik.solve(bad, as_span(seed))), IkErrc::bad_input);
  bad = good;
  bad.R(1, 2) = nan;
  EXPECT_EQ(code(ik.solve(bad, as_span(seed))), IkErrc::bad_input);
  bad = good;
  bad.R *= 1.001;
  EXPECT_EQ(code(ik.solve(bad, as_span(seed))), IkErrc::bad_input);
  bad = good;
  bad.R.col(0) *= -1;  // a mirror
  EXPECT_EQ(code(ik.solve(bad, as_span(seed))), IkErrc::bad_input);
  EXPECT_EQ(code(ik.solve(good, std::vector<double>(5))), IkErrc::bad_input);
  EXPECT_EQ(code(ik.solve(good, std::vector<double>(7))), IkErrc::bad_input);
  EXPECT_EQ(code(ik.solve(good, {})), IkErrc::bad_input);
  EXPECT_EQ(code(ik.solve(good, std::vector<double>{0, 0, nan, 0, 0, 0})), IkErrc::bad_input);
  EXPECT_EQ(code(IkSolver(arm, with(0, 1e-7, 50)).solve(good, as_span(seed))), IkErrc::bad_input);
  EXPECT_EQ(code(IkSolver(arm, with(1e-7, nan, 50)).solve(good, as_span(seed))), IkErrc::bad_input);
  EXPECT_EQ(code(IkSolver(arm, with(1e-7, 1e-7, -1)).solve(good, as_span(seed))),
            IkErrc::bad_input);
  EXPECT_EQ(code(IkSolver(arm, {.max_step = 0}).solve(good, as_span(seed))), IkErrc::bad_input);
  EXPECT_EQ(code(IkSolver(arm, {.max_step = nan}).solve(good, as_span(seed))), IkErrc::bad_input);
  EXPECT_EQ(code(IkSolver(Arm{}).solve(good, as_span(seed))), IkErrc::bad_input);
  EXPECT_FALSE(describe(ik.solve(bad, as_span(seed)).error(), arm).empty());
}

TEST(IkSolver, OptionsOutOfRangeAreNamedAtOnce) {
  const Arm arm = ur5e();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [&](IkOptions options, const std::string& word) {
    const auto made = IkSolver::create(arm, std::move(options));
    return !made && made.error().code == Errc::bad_input &&
           made.error().what.find(word) != std::string::npos;
  };
  EXPECT_TRUE(refused({.pos_tol = 0}, "pos_tol"));
  EXPECT_TRUE(refused({.pos_tol = nan}, "pos_tol"));
  EXPECT_TRUE(refused({.rot_tol = -1}, "rot_tol"));
  EXPECT_TRUE(refused({.max_iterations = 0}, "max_iterations"));
  EXPECT_TRUE(refused({.restarts = -1}, "restarts"));
  EXPECT_TRUE(refused({.max_step = nan}, "max_step"));
  EXPECT_FALSE(IkSolver::create(Arm{}, {}).has_value());
  const auto made = IkSolver::create(arm, {.restarts = 0});
  ASSERT_TRUE(made.has_value());
  const JointVec q = joint_vec(std::vector<double>{0.1, -1, 1, 0.4, 1, 0});
  EXPECT_TRUE(made->solve(fk(arm, as_span(q)), as_span(q)).has_value());
}

TEST(IkSolver, WithOtherOptionsIsAsIfMadeWithThem) {
  Rng rng(41);
  for (const Arm& arm : {ur5e(), panda(), random_arm(6, rng)}) {
    const IkSolver ik(arm);
    const IkOptions others[] = {{.max_step = 0.5},
                                {.task = IkTask::position},
                                {.closed_form = false},
                                {.valid = [](std::span<const double> q) { return q[0] > 0; }}};
    for (const IkOptions& options : others) {
      const IkSolver made(arm, options), changed = ik.with(options);
      EXPECT_EQ(changed.six_axis().has_value(), made.six_axis().has_value());
      EXPECT_EQ(changed.reach().outer(), made.reach().outer());
      for (int i = 0; i < 20; ++i) {
        const Pose X_WT = fk(arm, as_span(random_q(arm, rng)));
        const JointVec seed = random_q(arm, rng);
        const auto answer = changed.solve(X_WT, as_span(seed));
        const auto expected = made.solve(X_WT, as_span(seed));
        ASSERT_EQ(answer.has_value(), expected.has_value());
        if (answer) {
          EXPECT_EQ(answer->q, expected->q);
        }
      }
    }
  }
}

TEST(IkFailure, RefusedEverywhereIsCollision) {
  const Arm arm = ur5e();
  IkOptions options;
  options.valid = [](std::span<const double>) { return false; };
  const JointVec q = joint_vec(std::vector<double>{0.1, -1, 1, 0.4, 1, 0});
  const auto answer = IkSolver(arm, options).solve(fk(arm, as_span(q)), as_span(q));
  ASSERT_FALSE(answer.has_value());
  EXPECT_EQ(answer.error().code, IkErrc::collision);
  EXPECT_LT(answer.error().best.pos_err, 1e-7);
  EXPECT_LT((answer.error().best.q - q).norm(), 1e-6);  // the first answer met is kept
}

TEST(Ik, PredicateLeadsToAnotherBranch) {
  const Arm arm = ur5e();
  IkOptions options;
  options.valid = [](std::span<const double> q) { return q[2] < 0; };
  const IkSolver ik(arm, options);
  Rng rng(40);
  for (int i = 0; i < 100; ++i) {
    JointVec q = random_q(arm, rng);
    q[2] = rng.uniform(0.3, 2.8);
    q[4] = rng.uniform(0.3, 2.8);
    const auto answer = ik.solve(fk(arm, as_span(q)), as_span(q));
    ASSERT_TRUE(answer.has_value());
    EXPECT_LT(answer->q[2], 0);
  }
}

TEST(Ik, NamesOfTheReasons) {
  EXPECT_EQ(name(IkErrc::out_of_reach), "out_of_reach");
  EXPECT_EQ(name(IkErrc::inner_void), "inner_void");
  EXPECT_EQ(name(IkErrc::joint_limit), "joint_limit");
  EXPECT_EQ(name(IkErrc::collision), "collision");
  EXPECT_EQ(name(IkErrc::no_convergence), "no_convergence");
  EXPECT_EQ(name(IkErrc::too_far), "too_far");
  EXPECT_EQ(name(IkErrc::bad_input), "bad_input");
}

TEST(IkTask, HasItsWordsAndFewJointsAreAskedForThePositionAlone) {
  EXPECT_EQ(ik_task_names()[static_cast<std::size_t>(IkTask::position)], "position");
  EXPECT_EQ(ik_task_names().size(), 3U);
  Arm arm;
  arm.joints.resize(5);
  EXPECT_EQ(task_for(arm), IkTask::position);
  arm.joints.resize(6);
  EXPECT_EQ(task_for(arm), IkTask::pose);
}

}  // namespace
}  // namespace mjarm
