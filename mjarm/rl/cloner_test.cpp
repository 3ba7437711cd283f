#include "mjarm/rl/cloner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mjarm/rl/mixture_loss_internal.hpp"

namespace mjarm::rl {
namespace {

constexpr int kDims = 2, kWays = 3;

/// A drawn mixture and action.
struct MixtureCase {
  std::vector<float> out, log_std, action;

  explicit MixtureCase(std::uint64_t seed) {
    Rng rng(seed);
    const auto draw = [&](std::vector<float>& to, int n, double size) {
      for (int i = 0; i < n; ++i) to.push_back(static_cast<float>(size * rng.normal()));
    };
    draw(out, kWays * kDims + kWays, 1);
    draw(log_std, kWays * kDims + kWays, 0.3);
    draw(action, kDims, 1);
  }
  double loss(std::vector<double>& by_out, std::vector<double>& by_log_std) const {
    by_out.assign(out.size(), 0);
    by_log_std.assign(out.size(), 0);
    return detail::MixtureLoss(kDims, kWays)(out, log_std, action, by_out, by_log_std);
  }
  double loss() const {
    std::vector<double> a, b;
    return loss(a, b);
  }
};

TEST(MixtureLoss, IsMinusTheLogarithmOfTheDensity) {
  const MixtureCase one(3);
  double weights = 0, density = 0;
  for (int k = 0; k < kWays; ++k) weights += std::exp(double(one.out[kWays * kDims + k]));
  for (int k = 0; k < kWays; ++k) {
    double factor = std::exp(double(one.out[kWays * kDims + k])) / weights;
    for (int d = 0; d < kDims; ++d) {
      const int i = k * kDims + d;
      const double std = std::exp(double(one.log_std[i]));
      const double z = (double(one.action[d]) - double(one.out[i])) / std;
      factor *= std::exp(-0.5 * z * z) / (std * std::sqrt(2 * std::numbers::pi));
    }
    density += factor;
  }
  EXPECT_NEAR(one.loss(), -std::log(density), 1e-10);
}

TEST(MixtureLoss, SlopesAreFiniteDifferences) {
  constexpr float kStep = 1.0F / 256;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const MixtureCase one(seed);
    std::vector<double> by_out, by_log_std;
    one.loss(by_out, by_log_std);
    for (std::size_t i = 0; i < one.out.size(); ++i) {
      MixtureCase up = one, down = one;
      up.out[i] += kStep;
      down.out[i] -= kStep;
      const double rise = double(up.out[i]) - double(down.out[i]);
      EXPECT_NEAR(by_out[i], (up.loss() - down.loss()) / rise, 1e-4) << i;
      if (i >= kWays * kDims) continue;  // logits have no deviation
      up = down = one;
      up.log_std[i] += kStep;
      down.log_std[i] -= kStep;
      const double wide = double(up.log_std[i]) - double(down.log_std[i]);
      EXPECT_NEAR(by_log_std[i], (up.loss() - down.loss()) / wide, 1e-3) << i;
    }
  }
}

/// Half of who comes to x goes to 0.5 + x / 4, half to the opposite: the mean of both is 0.
Demonstrations two_ways() {
  return {.rows = 512,
          .observations = 1,
          .actions = 1,
          .show = [](std::size_t row, Rng*, std::span<float> observation, std::span<float> action) {
            const double x = static_cast<double>(row / 2) / 128 - 1;
            observation[0] = static_cast<float>(x);
            action[0] = static_cast<float>((0.5 + x / 4) * (row % 2 == 0 ? 1 : -1));
          }};
}

TEST(Cloner, GoesOneOfTwoWaysWhereTheMeanIsNone) {
  const Demonstrations data = two_ways();
  CloningOptions options{
      .hidden = {32}, .modes = 2, .batch = 64, .epochs = 150, .learning_rate = 1e-2};
  Cloner both(data, options);
  double first = 0, last = 0;
  for (int i = 0; i < options.epochs; ++i) (i == 0 ? first : last) = both.epoch();
  EXPECT_LT(last, first - 1);
  options.modes = 1;
  Cloner mean(data, options);
  while (mean.epochs() < options.epochs) mean.epoch();
  for (const float x : {-0.8F, -0.1F, 0.6F}) {
    EXPECT_NEAR(std::abs(both.policy().act({&x, 1})[0]), 0.5F + x / 4, 0.03F) << x;
    EXPECT_NEAR(mean.policy().act({&x, 1})[0], 0, 0.1F) << x;
  }
}

TEST(Cloner, GivesTheSameBytesForAnyNumberOfThreads) {
  const Demonstrations data = two_ways();
  CloningOptions options{.hidden = {16, 8}, .modes = 3, .batch = 300, .epochs = 3};
  Cloner one(data, options);
  options.threads = 3;
  Cloner three(data, options);
  for (int i = 0; i < options.epochs; ++i) EXPECT_EQ(one.epoch(), three.epoch());
  EXPECT_EQ(one.policy().tensors(), three.policy().tensors());
  options.seed = 2;
  Cloner other(data, options);
  EXPECT_NE(one.policy().tensors(), other.policy().tensors());
}

TEST(Cloner, TellsThatItDiverged) {
  const Demonstrations data = two_ways();
  const CloningOptions options{.hidden = {16}, .batch = 64, .epochs = 2, .learning_rate = 1e30};
  Cloner cloner(data, options);
  EXPECT_FALSE(std::isfinite(cloner.epoch()));
}

TEST(Cloner, KeepsDeviationsAboveTheLeast) {
  const Demonstrations data = two_ways();
  const CloningOptions options{.hidden = {16},
                               .modes = 2,
                               .batch = 64,
                               .epochs = 40,
                               .learning_rate = 0.1,
                               .least_std = 0.5};
  Cloner cloner(data, options);
  while (cloner.epochs() < options.epochs) cloner.epoch();
  for (const float value : cloner.policy().net.log_std()) EXPECT_GE(value, std::log(0.5F));
}

TEST(MixturePolicy, ComesBackFromItsTensorsAndRefusesOtherModes) {
  const MixturePolicy policy(Policy({2, MixturePolicy::outputs(3, 2), {4}, {}, Activation::relu}),
                             2);
  TensorSet set = policy.tensors();
  const Result<MixturePolicy> back = MixturePolicy::from(set);
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_EQ(back->actions(), 3);
  EXPECT_EQ(back->tensors(), set);
  for (const char* const modes : {"", "0", "3", "8", "two"}) {
    set.metadata["modes"] = modes;
    const Result<MixturePolicy> refused = MixturePolicy::from(set);
    ASSERT_FALSE(refused) << modes;
    EXPECT_THAT(refused.error().what, ::testing::HasSubstr("modes"));
  }
}

}  // namespace
}  // namespace mjarm::rl
