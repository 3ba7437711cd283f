#pragma once

#include <gtest/gtest.h>

#include <iostream>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"

namespace mjarm::testing {

/// Solves for fk of random configurations from random seeds and checks every answer on its own;
/// every miss is listed with its reason. Returns how many had an answer.
inline int count_solved(const Arm& arm, const IkSolver& ik, int rounds, Rng& rng) {
  int solved = 0;
  for (int i = 0; i < rounds; ++i) {
    const Pose X_goal = fk(arm, as_span(random_q(arm, rng)));
    const auto answer = ik.solve(X_goal, as_span(random_q(arm, rng)));
    if (!answer) {
      std::cout << arm.name << ", pose " << i << ": " << describe(answer.error(), arm) << '\n';
      continue;
    }
    ++solved;
    const Pose X = fk(arm, as_span(answer->q));
    EXPECT_LT((X.p - X_goal.p).norm(), 1.01e-7);
    EXPECT_LT(angle_between(X.R, X_goal.R), 1.01e-7);
    EXPECT_TRUE(within_limits(arm, as_span(answer->q)));
  }
  return solved;
}

}  // namespace mjarm::testing
