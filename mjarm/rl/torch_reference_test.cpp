#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "mjarm/rl/adam_internal.hpp"
#include "mjarm/rl/gae.hpp"
#include "mjarm/rl/net_levels_test.hpp"
#include "mjarm/rl/ppo_gradient_internal.hpp"
#include "mjarm/rl/ppo_loss_internal.hpp"
#include "tests/support/test_data.hpp"

/// Numbers of torch and stable-baselines3, made by testdata/make_torch_reference.py.
namespace mjarm::rl {
namespace {

using nlohmann::json;

const json& reference() {
  static const json data = support::load_json(MJARM_RL_TESTDATA "/torch_reference.json");
  return data;
}

template <class Range>
void expect_near(const Range& found, const std::vector<double>& wanted, double tolerance = 1e-5) {
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    ASSERT_NEAR(found[i], wanted[i], tolerance * (1 + std::abs(wanted[i]))) << i;
  }
}

PpoOptions options_of(const json& from) {
  PpoOptions options;
  options.clip = from.at("clip");
  options.value_clip = from.at("value_clip");
  options.value_weight = from.at("value_weight");
  options.entropy_weight = from.at("entropy_weight");
  options.normalise_advantages = from.at("normalise");
  return options;
}

/// A case of the file with all that it takes to learn from its samples.
struct ReferenceCase {
  const json& data;
  Policy policy;
  std::vector<float> observations, actions, log_probs, advantages, returns, values;
  std::vector<int> which;
  PpoOptions options;

  explicit ReferenceCase(const json& from) : data(from), policy(shape_of(from)) {
    const std::vector<float> start = from.at("start");
    EXPECT_EQ(start.size(), policy.parameters().size());
    std::ranges::copy(start, policy.parameters().begin());
    const json& samples = from.at("data");
    samples.at("observations").get_to(observations);
    samples.at("actions").get_to(actions);
    samples.at("log_probs").get_to(log_probs);
    samples.at("advantages").get_to(advantages);
    samples.at("returns").get_to(returns);
    samples.at("values").get_to(values);
    which.resize(values.size());
    std::iota(which.begin(), which.end(), 0);
    options = options_of(from.at("options"));
  }

  static PolicyShape shape_of(const json& from) {
    const bool tanh = from.at("options").at("activation") == "tanh";
    return {reference().at("observations"), reference().at("actions"), reference().at("actor"),
            reference().at("critic"), tanh ? Activation::tanh : Activation::relu};
  }
};

TEST(TorchReference, ForwardBackwardAndAdam) {
  for (const detail::NetKernels* kernels : testing::all_net_kernels()) {
    for (const json& data : reference().at("cases")) {
      SCOPED_TRACE(data.at("name"));
      ReferenceCase given(data);
      detail::Workers workers(2);
      detail::Networks networks(*kernels, given.policy, workers);
      std::vector<float> means(given.actions.size()), values(given.values.size());
      networks.means(given.observations, means);
      networks.values(given.observations, values);
      expect_near(means, data.at("means"));
      expect_near(values, data.at("critic"));

      detail::PpoGradient gradient(given.policy.shape(), given.policy.parameters().size(),
                                   networks);
      detail::Adam adam(given.policy.parameters().size());
      const json& steps = reference().at("adam");
      for (int step = 0; step < steps.at("steps"); ++step) {
        const detail::LossMeans losses =
            gradient.compute(given.policy,
                             {given.observations, given.actions, given.log_probs, given.advantages,
                              given.returns, given.values},
                             given.which, given.options);
        if (step == 0) {
          const json& wanted = data.at("losses");
          EXPECT_NEAR(losses.policy, wanted.at("policy"), 1e-5);
          EXPECT_NEAR(losses.value, wanted.at("value"), 1e-5);
          EXPECT_NEAR(losses.kl, wanted.at("kl"), 1e-5);
          EXPECT_NEAR(losses.clip_fraction, wanted.at("clip_fraction"), 1e-5);
          EXPECT_NEAR(detail::Gaussian(given.policy.log_std()).entropy(), wanted.at("entropy"),
                      1e-5);
          expect_near(gradient.gradient(), data.at("gradient"));
        }
        const double norm = std::sqrt(gradient.squares());
        const double scale = std::min(1.0, steps.at("max_norm").get<double>() / (norm + 1e-6));
        adam.step(*kernels, workers, gradient.gradient(), scale, steps.at("rate"),
                  steps.at("epsilon"), given.policy.parameters());
        networks.pack(given.policy);
      }
      expect_near(given.policy.parameters(), data.at("after_adam"));
    }
  }
}

TEST(TorchReference, PolicyAlone) {
  for (const json& data : reference().at("cases")) {
    const ReferenceCase given(data);
    const std::vector<double> means = data.at("means"), values = data.at("critic");
    for (std::size_t i = 0; i < given.values.size(); ++i) {
      const auto row = std::span(given.observations).subspan(5 * i, 5);
      const Eigen::VectorXf mean = given.policy.act(row);
      expect_near(mean, {means.begin() + 3 * long(i), means.begin() + 3 * long(i) + 3});
      EXPECT_NEAR(given.policy.value(row), values[i], 1e-5);
    }
  }
}

TEST(TorchReference, Advantages) {
  const json& data = reference().at("gae");
  const std::vector<float> rewards = data.at("rewards"), values = data.at("values"),
                           final_values = data.at("final_values"),
                           last_values = data.at("last_values");
  const std::vector<std::uint8_t> terminated = data.at("terminated"),
                                  truncated = data.at("truncated");
  std::vector<float> advantages(rewards.size()), returns(rewards.size());
  estimate_advantages(
      {data.at("copies"), rewards, values, terminated, truncated, final_values, last_values},
      data.at("discount"), data.at("gae_lambda"), advantages, returns);
  expect_near(advantages, data.at("advantages"));
  expect_near(returns, data.at("returns"));
}

}  // namespace
}  // namespace mjarm::rl
