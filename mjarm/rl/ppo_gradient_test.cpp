#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include "mjarm/rl/first_weights_internal.hpp"
#include "mjarm/rl/net_levels_test.hpp"
#include "mjarm/rl/ppo_loss_internal.hpp"
#include "mjarm/rl/reference_loss_test.hpp"

namespace mjarm::rl {
namespace {

/// A policy with all layers of a size, and samples that it would learn from.
struct Setting {
  Policy policy;
  std::vector<float> observations, actions, log_probs, advantages, returns, values;
  std::vector<int> which;

  Setting(PolicyShape shape, int count, std::uint64_t seed) : policy(std::move(shape)) {
    Rng rng(seed);
    for (float& value : policy.parameters()) value = static_cast<float>(0.4 * rng.normal());
    const auto n = static_cast<std::size_t>(count);
    const auto draw = [&](std::vector<float>& to, std::size_t size) {
      for (std::size_t i = 0; i < size; ++i) to.push_back(static_cast<float>(rng.normal()));
    };
    draw(observations, n * static_cast<std::size_t>(policy.shape().observations));
    draw(actions, n * static_cast<std::size_t>(policy.shape().actions));
    draw(advantages, n);
    draw(returns, n);
    const detail::Gaussian gaussian(policy.log_std());
    for (std::size_t i = 0; i < n; ++i) {
      const auto row = std::span(observations)
                           .subspan(i * policy.shape().observations, policy.shape().observations);
      const Eigen::VectorXf mean = policy.act(row);
      const double log_prob =
          gaussian.log_prob(&actions[i * static_cast<std::size_t>(mean.size())], mean.data());
      // Ratios on both sides of the clip, values within and beyond theirs.
      log_probs.push_back(static_cast<float>(log_prob + 0.2 * rng.normal()));
      values.push_back(static_cast<float>(policy.value(row) + 0.3 * rng.normal()));
    }
    which.resize(n);
    std::iota(which.begin(), which.end(), 0);
  }

  [[nodiscard]] detail::Samples samples() const {
    return {observations, actions, log_probs, advantages, returns, values};
  }
  /// The gradient, and the losses.
  std::vector<float> gradient(const detail::NetKernels& kernels, int threads,
                              const PpoOptions& options,
                              detail::LossMeans* losses = nullptr) const {
    detail::Workers workers(threads);
    detail::Networks networks(kernels, policy, workers);
    detail::PpoGradient gradient(policy.shape(), policy.parameters().size(), networks);
    const detail::LossMeans found = gradient.compute(policy, samples(), which, options);
    if (losses != nullptr) *losses = found;
    return {gradient.gradient().begin(), gradient.gradient().end()};
  }
};

/// One term of the loss at a time, then all of them.
std::vector<PpoOptions> all_terms() {
  PpoOptions surrogate{.value_weight = 0, .normalise_advantages = false};
  PpoOptions normalised{.value_weight = 0};
  PpoOptions value{.value_weight = 1};
  PpoOptions clipped_value{.value_clip = 0.25, .value_weight = 1};
  PpoOptions entropy{.value_weight = 0, .entropy_weight = 0.3};
  PpoOptions all{.clip = 0.1, .value_clip = 0.2, .value_weight = 0.5, .entropy_weight = 0.01};
  return {surrogate, normalised, value, clipped_value, entropy, all};
}

void expect_like(const std::vector<float>& found, const std::vector<double>& wanted) {
  ASSERT_EQ(found.size(), wanted.size());
  double largest = 0;
  for (const double value : wanted) largest = std::max(largest, std::abs(value));
  ASSERT_GT(largest, 1e-3);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    ASSERT_NEAR(found[i], wanted[i], 1e-3 * std::abs(wanted[i]) + 1e-5 * largest) << i;
  }
}

TEST(PpoGradient, AgreesWithFiniteDifferencesOfEachTerm) {
  // More samples than one pass takes, so that slices and blocks are there.
  const Setting setting({.observations = 5, .actions = 3, .actor = {6, 4}, .critic = {5}}, 160, 1);
  for (const PpoOptions& options : all_terms()) {
    const auto samples = setting.samples();
    const std::vector<double> wanted =
        testing::ReferenceLoss(setting.policy, samples, setting.which, options).gradient();
    for (const detail::NetKernels* kernels : testing::all_net_kernels()) {
      expect_like(setting.gradient(*kernels, 1, options), wanted);
    }
  }
}

TEST(PpoGradient, AgreesWithFiniteDifferencesForOtherNets) {
  const PolicyShape shapes[] = {
      {.observations = 4, .actions = 1, .actor = {}, .critic = {}},
      {.observations = 3,
       .actions = 2,
       .actor = {8},
       .critic = {5, 4, 3},
       .activation = Activation::relu},
      {.observations = 40, .actions = 2, .actor = {5}, .critic = {33}},
  };
  for (const PolicyShape& shape : shapes) {
    Setting setting(shape, 30, 2);
    setting.which = {3, 1, 4, 15, 9, 26, 5, 8, 29, 7};  // some of the samples, in any order
    const auto samples = setting.samples();
    const PpoOptions options = all_terms().back();
    const std::vector<double> wanted =
        testing::ReferenceLoss(setting.policy, samples, setting.which, options).gradient();
    expect_like(setting.gradient(detail::net_kernels(simd_level()), 2, options), wanted);
  }
}

TEST(PpoGradient, LossesAreThoseOfTheDefinition) {
  const Setting setting({.observations = 5, .actions = 3, .actor = {9}, .critic = {7}}, 200, 3);
  for (const PpoOptions& options : all_terms()) {
    detail::LossMeans losses;
    setting.gradient(detail::net_kernels(simd_level()), 1, options, &losses);
    const auto samples = setting.samples();
    const std::vector<double> parameters(setting.policy.parameters().begin(),
                                         setting.policy.parameters().end());
    const double wanted =
        testing::ReferenceLoss(setting.policy, samples, setting.which, options).total(parameters);
    const double entropy = detail::Gaussian(setting.policy.log_std()).entropy();
    EXPECT_NEAR(
        losses.policy + options.value_weight * losses.value - options.entropy_weight * entropy,
        wanted, 1e-5 * (1 + std::abs(wanted)));
    EXPECT_GT(losses.kl, 0);
    EXPECT_GT(losses.clip_fraction, 0);
    EXPECT_LT(losses.clip_fraction, 1);
  }
}

TEST(PpoGradient, SameBytesForAnyNumberOfThreads) {
  const Setting setting({.observations = 24, .actions = 7, .actor = {64, 64}, .critic = {48}}, 2500,
                        4);
  const PpoOptions options;
  const detail::NetKernels& kernels = detail::net_kernels(simd_level());
  const std::vector<float> one = setting.gradient(kernels, 1, options);
  for (const int threads : {2, 3, 4}) EXPECT_EQ(setting.gradient(kernels, threads, options), one);
}

TEST(PpoGradient, RowsComeOutAsPolicySaysAlone) {
  Policy policy({.observations = 24, .actions = 7, .actor = {64, 32}, .critic = {100}});
  Rng rng(5);
  detail::draw_first_weights(policy, -0.5, rng);
  std::vector<float> rows(24 * 77), means(7 * 77), values(77);
  for (float& value : rows) value = static_cast<float>(rng.normal());
  for (const detail::NetKernels* kernels : testing::all_net_kernels()) {
    detail::Workers workers(2);
    detail::Networks networks(*kernels, policy, workers);
    networks.means(rows, means);
    networks.values(rows, values);
    for (std::size_t i = 0; i < 77; ++i) {
      const auto row = std::span(rows).subspan(24 * i, 24);
      const Eigen::VectorXf mean = policy.act(row);
      for (std::size_t k = 0; k < 7; ++k) {
        ASSERT_NEAR(means[7 * i + k], mean[static_cast<Eigen::Index>(k)], 1e-6);
      }
      ASSERT_NEAR(values[i], policy.value(row), 1e-5);
    }
  }
}

TEST(FirstWeights, AreOrthogonalWithTheirGains) {
  Policy policy({.observations = 20, .actions = 4, .actor = {30, 10}, .critic = {16}});
  Rng rng(6);
  detail::draw_first_weights(policy, -0.7, rng);
  using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  for (const ParameterBlock& block : policy.blocks()) {
    const Eigen::Map<const Rows> W(policy.parameters().data() + block.offset, block.rows,
                                   block.cols);
    if (!block.name.ends_with(".weight")) {
      EXPECT_TRUE(W.isConstant(block.name == "log_std" ? -0.7F : 0.0F)) << block.name;
      continue;
    }
    double gain = std::sqrt(2.0);
    if (block.name == "actor.2.weight") gain = 0.01;
    if (block.name == "critic.1.weight") gain = 1;
    const Eigen::MatrixXd A = W.cast<double>() / gain;
    const Eigen::MatrixXd B = A.rows() < A.cols() ? Eigen::MatrixXd(A.transpose()) : A;
    const Eigen::MatrixXd gram = B.transpose() * B;
    EXPECT_TRUE(gram.isIdentity(1e-5)) << block.name;
  }
}

}  // namespace
}  // namespace mjarm::rl
