#include "mjarm/kinematics/ik_batch.hpp"

#include <gtest/gtest.h>

#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/compare_test.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {
namespace {

using Answer = Result<IkSolution, IkFailure>;

struct Cases {
  std::vector<Pose> X_WT;
  std::vector<double> q_seed;
};

/// Random poses, every tenth out of reach, each with a random seed.
Cases cases(const Arm& arm, int n) {
  Rng rng(1);
  Cases out;
  for (int i = 0; i < n; ++i) {
    out.X_WT.push_back(fk(arm, as_span(testing::random_q(arm, rng))));
    if (i % 10 == 3) out.X_WT.back().p *= 5;
    const JointVec seed = testing::random_q(arm, rng);
    out.q_seed.insert(out.q_seed.end(), seed.begin(), seed.end());
  }
  return out;
}

void expect_same(const Answer& a, const Answer& b) {
  ASSERT_EQ(a.has_value(), b.has_value());
  const IkSolution& x = a ? *a : a.error().best;
  const IkSolution& y = b ? *b : b.error().best;
  EXPECT_TRUE(testing::same_bits(x.q, y.q));
  EXPECT_EQ(x.pos_err, y.pos_err);
  EXPECT_EQ(x.iterations, y.iterations);
  if (!a) {
    EXPECT_EQ(a.error().code, b.error().code);
    EXPECT_EQ(a.error().amount, b.error().amount);
  }
}

TEST(IkBatch, EqualsSingleCallsForAnyNumberOfThreads) {
  for (const Arm& arm : {testing::ur5e(), testing::panda()}) {
    for (const bool closed_form : {true, false}) {
      const IkSolver ik(arm, {.closed_form = closed_form});
      const Cases all = cases(arm, 500);
      const auto dof = static_cast<std::size_t>(arm.dof());
      for (const int threads : {1, 2, 3, 0}) {
        const std::vector<Answer> answers =
            solve_batch(ik, all.X_WT, all.q_seed, {.threads = threads});
        ASSERT_EQ(answers.size(), 500U);
        for (std::size_t i = 0; i < answers.size(); ++i) {
          expect_same(answers[i], ik.solve(all.X_WT[i], {&all.q_seed[i * dof], dof}));
        }
      }
    }
  }
}

TEST(IkBatch, OneSeedMayServeAll) {
  const Arm arm = testing::ur5e();
  const IkSolver ik(arm);
  const Cases all = cases(arm, 70);
  const std::vector<Answer> answers = solve_batch(ik, all.X_WT, as_span(arm.home));
  for (std::size_t i = 0; i < answers.size(); ++i) {
    expect_same(answers[i], ik.solve(all.X_WT[i], as_span(arm.home)));
  }
}

TEST(IkBatch, SeedsOfAWrongSizeAreBadInput) {
  const Arm arm = testing::ur5e();
  const IkSolver ik(arm);
  const Cases all = cases(arm, 5);
  for (const std::size_t size : {0U, 5U, 12U, 29U}) {
    for (const Answer& answer : solve_batch(ik, all.X_WT, {all.q_seed.data(), size})) {
      ASSERT_FALSE(answer.has_value());
      EXPECT_EQ(answer.error().code, IkErrc::bad_input);
    }
  }
  EXPECT_TRUE(solve_batch(ik, {}, as_span(arm.home)).empty());
}

TEST(IkBatch, ProgressIsToldToTheEnd) {
  const Arm arm = testing::panda();
  const IkSolver ik(arm);
  const Cases all = cases(arm, 300);
  std::vector<std::size_t> told;
  const auto answers =
      solve_batch(ik, all.X_WT, all.q_seed,
                  {.threads = 2, .progress = [&](std::size_t done) { told.push_back(done); }});
  ASSERT_FALSE(told.empty());
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 300U);
}

}  // namespace
}  // namespace mjarm
