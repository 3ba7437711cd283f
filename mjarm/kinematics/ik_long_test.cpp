// What must hold for every answer, over many poses of both arms and both ways of solving.
#include <gtest/gtest.h>

#include <tuple>

#include "mjarm/kinematics/compare_test.hpp"
#include "mjarm/kinematics/count_solved_test.hpp"
#include "mjarm/kinematics/ik_all.hpp"
#include "mjarm/kinematics/ik_batch.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"

namespace mjarm {
namespace {

using Answer = Result<IkSolution, IkFailure>;

bool same_bits(const Answer& a, const Answer& b) {
  return a.has_value() == b.has_value() &&
         testing::same_bits(a ? a->q : a.error().best.q, b ? b->q : b.error().best.q);
}

/// Whether the arm has six joints, and whether the closed form may be used.
class IkAtScale : public ::testing::TestWithParam<std::tuple<bool, bool>> {
 protected:
  [[nodiscard]] const Arm& arm() const { return arm_; }
  [[nodiscard]] IkSolver solver() const {
    return IkSolver(arm_, {.closed_form = std::get<1>(GetParam())});
  }
  /// Poses and seeds in blocks, to bound the memory of a long run.
  static constexpr int kBlock = 500;
  [[nodiscard]] static int blocks() { return testing::rounds(2, 200); }

 private:
  Arm arm_ = std::get<0>(GetParam()) ? testing::ur5e() : testing::panda();
};

TEST_P(IkAtScale, EveryPoseIsFoundAgain) {
  Rng rng(120);
  const int count = kBlock * blocks();
  // The numeric search is no proof: one pose in a thousand may need more restarts.
  const int missed = std::get<1>(GetParam()) ? 0 : count / 1000;
  EXPECT_GE(testing::count_solved(arm(), solver(), count, rng), count - missed);
}

TEST_P(IkAtScale, EqualBitsTheSecondTimeAndInABatch) {
  Rng rng(121);
  const auto dof = static_cast<std::size_t>(arm().dof());
  for (int block = 0; block < blocks(); ++block) {
    std::vector<Pose> X_WT;
    std::vector<double> seeds;
    for (int i = 0; i < kBlock; ++i) {
      X_WT.push_back(fk(arm(), as_span(testing::random_q(arm(), rng))));
      if (i % 20 == 3) X_WT.back().p *= rng.uniform(1, 3);
      const JointVec seed = testing::random_q(arm(), rng);
      seeds.insert(seeds.end(), seed.begin(), seed.end());
    }
    const auto batch = solve_batch(solver(), X_WT, seeds, {.threads = 2});
    const IkSolver ik = solver();
    for (std::size_t i = 0; i < X_WT.size(); ++i) {
      const Answer single = ik.solve(X_WT[i], {&seeds[i * dof], dof});
      ASSERT_TRUE(same_bits(single, batch[i])) << block << ' ' << i;
      if (i % 10 != 0) continue;
      ASSERT_TRUE(same_bits(single, ik.solve(X_WT[i], {&seeds[i * dof], dof})));
    }
  }
}

TEST_P(IkAtScale, BranchesDifferAndReachThePose) {
  Rng rng(122);
  const IkSolver ik = solver();
  const bool quick = ik.six_axis().has_value();
  for (int i = 0; i < kBlock * blocks() / (quick ? 1 : 20); ++i) {
    const Pose X_goal = fk(arm(), as_span(testing::random_q(arm(), rng)));
    const JointVec seed = testing::random_q(arm(), rng);
    const auto all = solve_all(ik, X_goal, as_span(seed), {.starts = 60});
    if (!all && !std::get<1>(GetParam())) continue;  // EveryPoseIsFoundAgain counts these
    ASSERT_TRUE(all.has_value()) << i;
    if (arm().dof() == 6) {
      EXPECT_LE(all->size(), 8U) << i;
    }
    for (std::size_t k = 0; k < all->size(); ++k) {
      const JointVec& q = (*all)[k].q;
      const Pose X = fk(arm(), as_span(q));
      EXPECT_LT((X.p - X_goal.p).norm(), 1.01e-7);
      EXPECT_LT(angle_between(X.R, X_goal.R), 1.01e-7);
      EXPECT_TRUE(within_limits(arm(), as_span(q)));
      for (std::size_t j = 0; j < k; ++j) {
        EXPECT_GE((q - (*all)[j].q).cwiseAbs().maxCoeff(), 1e-3) << i;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Arms, IkAtScale, ::testing::Combine(::testing::Bool(), ::testing::Bool()),
                         [](const auto& name) {
                           return std::string(std::get<0>(name.param) ? "Ur5e" : "Panda") +
                                  (std::get<1>(name.param) ? "ClosedForm" : "Numeric");
                         });

}  // namespace
}  // namespace mjarm
