#include "mjarm/rl/gae.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mjarm/core/rng.hpp"

namespace mjarm::rl {
namespace {

struct Drawn {
  int steps, copies;
  std::vector<float> rewards, values, final_values, last_values;
  std::vector<std::uint8_t> terminated, truncated;

  Drawn(int step_count, int copy_count, double share_of_ends, Rng& rng)
      : steps(step_count), copies(copy_count) {
    for (int i = 0; i < steps * copies; ++i) {
      rewards.push_back(static_cast<float>(rng.normal()));
      values.push_back(static_cast<float>(rng.normal()));
      terminated.push_back(rng.uniform() < share_of_ends ? 1 : 0);
      truncated.push_back(rng.uniform() < share_of_ends ? 1 : 0);  // both happen
      // Where nothing was cut, this must not be looked at.
      final_values.push_back(truncated.back() != 0 ? static_cast<float>(rng.normal()) : NAN);
    }
    for (int i = 0; i < copies; ++i) last_values.push_back(static_cast<float>(rng.normal()));
  }
  [[nodiscard]] Experience view() const {
    return {copies, rewards, values, terminated, truncated, final_values, last_values};
  }
  /// The one-step error, straight from the definition.
  [[nodiscard]] double error(int t, int copy, double discount) const {
    const int i = t * copies + copy;
    double next = t + 1 < steps ? values[i + copies] : last_values[copy];
    if (truncated[i] != 0) next = final_values[i];
    if (terminated[i] != 0) next = 0;
    return rewards[i] + discount * next - values[i];
  }
};

TEST(Gae, IsTheSumOfItsDefinition) {
  Rng rng(1);
  for (int round = 0; round < 50; ++round) {
    const Drawn drawn(1 + static_cast<int>(rng.below(20)), 1 + static_cast<int>(rng.below(5)),
                      rng.uniform(0, 0.4), rng);
    const double discount = rng.uniform(0.5, 1), lambda = rng.uniform();
    std::vector<float> advantages(drawn.rewards.size()), returns(drawn.rewards.size());
    estimate_advantages(drawn.view(), discount, lambda, advantages, returns);
    for (int copy = 0; copy < drawn.copies; ++copy) {
      for (int t = 0; t < drawn.steps; ++t) {
        double sum = 0;
        for (int l = t; l < drawn.steps; ++l) {
          sum += std::pow(discount * lambda, l - t) * drawn.error(l, copy, discount);
          const int i = l * drawn.copies + copy;
          if (drawn.terminated[i] != 0 || drawn.truncated[i] != 0) break;
        }
        const int i = t * drawn.copies + copy;
        ASSERT_NEAR(advantages[i], sum, 1e-5);
        ASSERT_NEAR(returns[i], sum + drawn.values[i], 1e-5);
      }
    }
  }
}

TEST(Gae, ExactValuesHaveNoAdvantage) {
  // Reward 1 a step, discount 0.9: the value of going on for ever is 10, wherever it is cut.
  std::vector<float> rewards(6, 1), values(6, 10), last(1, 10), advantages(6), returns(6);
  std::vector<float> final_values(6, 10);
  std::vector<std::uint8_t> terminated(6, 0), truncated = {0, 0, 1, 0, 1, 0};
  estimate_advantages({1, rewards, values, terminated, truncated, final_values, last}, 0.9, 0.95,
                      advantages, returns);
  for (const float advantage : advantages) EXPECT_NEAR(advantage, 0, 1e-6);
  // Taken for an end, the cut would look like a loss of all that followed.
  std::swap(terminated, truncated);
  estimate_advantages({1, rewards, values, terminated, truncated, final_values, last}, 0.9, 0.95,
                      advantages, returns);
  EXPECT_NEAR(advantages[2], -9, 1e-5);
}

}  // namespace
}  // namespace mjarm::rl
