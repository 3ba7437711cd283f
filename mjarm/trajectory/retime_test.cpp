#include <gtest/gtest.h>

#include <cmath>

#include "mjarm/core/rng.hpp"
#include "mjarm/trajectory/retime_internal.hpp"

namespace mjarm::detail {
namespace {

/// Random rows that leave room: any number of knots, so that the last lanes are filled up or not.
RetimeProblem random_problem(std::size_t knots, bool torques, Rng& rng) {
  RetimeProblem p;
  p.rows = 3;
  p.a_rows = torques ? 5 : 3;
  for (std::size_t i = 0; i < knots; ++i) {
    p.tau.push_back(i == 0 ? 0 : p.tau.back() + rng.uniform(0.5, 1.5) / double(knots));
    p.knots.push_back(i);
    p.u_max.push_back(rng.uniform(1, 4));
    for (std::size_t r = 0; r < p.a_rows; ++r) {
      p.a_a.push_back(rng.uniform(-1, 1));
      p.v_a.push_back(rng.uniform(-0.5, 0.5));
      p.root_a.push_back(torques ? rng.uniform(-0.2, 0.2) : 0);
      p.still.push_back(torques ? rng.uniform(-0.3, 0.3) : 0);
    }
  }
  for (std::size_t k = 0; k < (2 * knots - 2) * p.rows; ++k) {
    p.j_j.push_back(rng.uniform(-1, 1));
    p.a_j.push_back(rng.uniform(-0.3, 0.3));
    p.v_j.push_back(rng.uniform(-0.1, 0.1));
  }
  return p;
}

TEST(Retime, KeepsEveryBoundWhateverTheNumberOfKnots) {
  Rng rng(1);
  constexpr double kRounded = 1 + 1e-9;
  for (std::size_t knots = 3; knots < 40; ++knots) {
    const RetimeProblem p = random_problem(knots, knots % 2 == 0, rng);
    const TimeLaw law = retime(p);
    ASSERT_EQ(law.u.size(), knots);
    for (std::size_t i = 0; i < knots; ++i) {
      const double u = law.u[i], du = law.du[i];
      EXPECT_GT(u, 0);
      EXPECT_LT(u, p.u_max[i] * kRounded);
      for (std::size_t r = i * p.a_rows; r < (i + 1) * p.a_rows; ++r) {
        const double a =
            p.a_a[r] * u + 0.5 * p.v_a[r] * du + p.root_a[r] * std::sqrt(u) + p.still[r];
        EXPECT_LT(std::abs(a), kRounded) << knots << " " << i;
      }
      for (const bool after : {false, true}) {
        if (after ? i + 1 == knots : i == 0) continue;
        const std::size_t cell = after ? i : i - 1;
        const double bend = (law.du[cell + 1] - law.du[cell]) / (p.tau[cell + 1] - p.tau[cell]);
        const std::size_t side = (after ? 2 * i : 2 * i - 1) * p.rows;
        for (std::size_t r = side; r < side + p.rows; ++r) {
          const double j =
              std::sqrt(u) * (p.j_j[r] * u + 1.5 * p.a_j[r] * du + 0.5 * p.v_j[r] * bend);
          EXPECT_LT(std::abs(j), kRounded) << knots << " " << i;
        }
      }
    }
  }
}

TEST(Retime, WhereOnlySpeedIsBoundItIsReached) {
  for (const std::size_t knots : {3U, 8U, 9U, 17U, 100U}) {
    RetimeProblem p;
    p.rows = p.a_rows = 1;
    for (std::size_t i = 0; i < knots; ++i) {
      p.tau.push_back(double(i) / double(knots - 1));
      p.knots.push_back(i);
      p.u_max.push_back(4);
    }
    p.a_a = p.v_a = p.root_a = p.still = std::vector<double>(knots, 0.0);
    p.j_j = p.a_j = p.v_j = std::vector<double>(2 * knots - 2, 0.0);
    EXPECT_NEAR(retime(p).t.back(), 0.5, 5e-3) << knots;
  }
}

TEST(Retime, TheSameProblemHasTheSameAnswerToTheLastBit) {
  Rng rng(3);
  const RetimeProblem p = random_problem(30, true, rng);
  const TimeLaw first = retime(p), second = retime(p);
  EXPECT_EQ(first.t, second.t);
  EXPECT_EQ(first.u, second.u);
}

}  // namespace
}  // namespace mjarm::detail
