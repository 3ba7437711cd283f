#include <gtest/gtest.h>

#include <cmath>

#include "mjarm/rl/first_weights_internal.hpp"
#include "mjarm/rl/ppo_loss_internal.hpp"
#include "mjarm/rl/rollout_internal.hpp"
#include "mjarm/rl/toy_envs_test.hpp"

namespace mjarm::rl {
namespace {

using testing::PointMass;

/// An untrained policy, somewhat different from row to row.
Policy drawn_policy() {
  Policy policy({.observations = 4, .actions = 2, .actor = {16}, .critic = {8}});
  Rng rng(8);
  detail::draw_first_weights(policy, -0.3, rng);
  for (float& value : policy.parameters()) value += static_cast<float>(0.1 * rng.normal());
  return policy;
}

/// A point mass under such a policy, whose normaliser has seen something.
struct Collecting {
  PointMass env{6};
  Policy policy = drawn_policy();
  detail::Workers workers{2};
  detail::Networks networks{detail::net_kernels(simd_level()), policy, workers};
  Rng rng{7};
  detail::OpenEpisodes open{6};
  detail::Rollout rollout{70, 6, policy.shape()};

  Collecting() {
    EXPECT_TRUE(env.reset(3));
    policy.normaliser.absorb(env.observations());
    EXPECT_TRUE(detail::collect(env, policy, networks, rng, open, rollout));
  }
};

TEST(Rollout, HoldsWhatHappened) {
  Collecting run;
  const detail::Rollout& rollout = run.rollout;
  const detail::Gaussian gaussian(run.policy.log_std());
  std::int64_t ends = 0;
  std::size_t cuts = 0;
  double sum_of_returns = 0, open_returns = 0;
  for (std::size_t i = 0; i < rollout.samples(); ++i) {
    const float* now = &rollout.observations[4 * i];
    const float* next = &rollout.observations[4 * (i + 6)];
    const float* action = &rollout.actions[2 * i];
    const Eigen::VectorXf mean = run.policy.act({now, 4});
    EXPECT_NEAR(rollout.log_probs[i], gaussian.log_prob(action, mean.data()), 1e-4);
    // The rules of the task lead from one row to the next, and to the final one at a cut.
    const bool cut = rollout.truncated[i] != 0, end = rollout.terminated[i] != 0;
    if (cut) {
      ASSERT_EQ(rollout.cut.at(cuts), i);
      next = &rollout.final_observations.at(4 * cuts++);
    }
    ends += cut || end;
    sum_of_returns += rollout.rewards[i];
    if (end) continue;
    for (int k = 0; k < 2; ++k) {
      EXPECT_NEAR(next[k], now[k] - 0.2F * std::clamp(action[k], -1.0F, 1.0F), 1e-6);
    }
    EXPECT_NEAR(rollout.rewards[i], -std::hypot(next[0], next[1]), 1e-6);
  }
  EXPECT_GT(cuts, 0u);
  EXPECT_EQ(rollout.cut.size(), cuts);
  EXPECT_EQ(rollout.final_observations.size(), 4 * cuts);
  EXPECT_EQ(rollout.ended, ends);
  double open_steps = 0;
  for (std::size_t copy = 0; copy < 6; ++copy) {
    open_returns += run.open.returns[copy];
    open_steps += static_cast<double>(run.open.lengths[copy]);
  }
  EXPECT_NEAR(rollout.ended_returns + open_returns, sum_of_returns,
              1e-6 * std::abs(sum_of_returns));
  EXPECT_EQ(rollout.ended_steps + open_steps, 70 * 6);
}

TEST(Rollout, ActionsHaveTheDeviationOfThePolicy) {
  Collecting run;
  double squares = 0;
  for (std::size_t i = 0; i < run.rollout.samples(); ++i) {
    const auto row = std::span(run.rollout.observations).subspan(4 * i, 4);
    squares += std::pow(run.rollout.actions[2 * i] - run.policy.act(row)[0], 2);
  }
  const double deviation = std::sqrt(squares / static_cast<double>(run.rollout.samples()));
  EXPECT_NEAR(deviation, std::exp(double(run.policy.log_std()[0])), 0.15 * deviation);
}

TEST(Rollout, ProbabilitiesAreTheSameBytesInOneGo) {
  Collecting run;
  const std::vector<float> step_by_step = run.rollout.log_probs;
  detail::update_log_probs(run.policy, run.networks, run.rollout);
  EXPECT_EQ(run.rollout.log_probs, step_by_step);
}

TEST(Rollout, RewardsAreScaledByTheDeviationOfTheReturn) {
  Collecting run;
  detail::Rollout first = run.rollout, second = run.rollout;
  detail::OpenEpisodes open(6);
  Normaliser scale{Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1), 0, 10};
  std::vector<double> returns, going(6, 0.0);
  for (int round = 0; round < 2; ++round) {  // the second goes on where the first stopped
    for (std::size_t i = 0; i < run.rollout.samples(); ++i) {
      going[i % 6] = 0.9 * going[i % 6] + double(run.rollout.rewards[i]);
      returns.push_back(going[i % 6]);
      if (run.rollout.truncated[i] != 0 || run.rollout.terminated[i] != 0) going[i % 6] = 0;
    }
    detail::Rollout& scaled = round == 0 ? first : second;
    detail::scale_rewards(0.9, scale, open, scaled, nullptr);
    double mean = 0, variance = 0;
    for (const double value : returns) mean += value / double(returns.size());
    for (const double value : returns)
      variance += std::pow(value - mean, 2) / double(returns.size());
    for (std::size_t i = 0; i < scaled.samples(); ++i) {
      ASSERT_NEAR(scaled.rewards[i], run.rollout.rewards[i] / std::sqrt(variance), 1e-5);
    }
  }
}

}  // namespace
}  // namespace mjarm::rl
