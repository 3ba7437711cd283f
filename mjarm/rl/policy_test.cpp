#include "mjarm/rl/policy.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mjarm/core/rng.hpp"

namespace mjarm::rl {
namespace {

using ::testing::HasSubstr;

Policy random_policy(PolicyShape shape) {
  Policy policy(std::move(shape));
  Rng rng(1);
  for (float& value : policy.parameters()) value = static_cast<float>(rng.normal());
  for (double& value : policy.normaliser.mean) value = rng.normal();
  for (double& value : policy.normaliser.variance) value = rng.uniform(0.1, 2);
  policy.normaliser.count = 100;
  return policy;
}

TEST(Policy, LaysOutItsParametersWithoutGaps) {
  const Policy policy({.observations = 3, .actions = 2, .actor = {4}, .critic = {5, 6}});
  std::vector<std::string> names;
  std::size_t offset = 0;
  for (const ParameterBlock& block : policy.blocks()) {
    names.push_back(block.name);
    EXPECT_EQ(block.offset, offset);
    offset += static_cast<std::size_t>(block.rows * block.cols);
  }
  EXPECT_EQ(offset, policy.parameters().size());
  EXPECT_THAT(names, ::testing::ElementsAre("actor.0.weight", "actor.0.bias", "actor.1.weight",
                                            "actor.1.bias", "critic.0.weight", "critic.0.bias",
                                            "critic.1.weight", "critic.1.bias", "critic.2.weight",
                                            "critic.2.bias", "log_std"));
}

TEST(Policy, ComputesWhatItSays) {
  // y = 2 tanh(x0' - x1' + 0.5) + 0.25 for the action, x' normalised; the critic is a sum.
  Policy policy({.observations = 2, .actions = 1, .actor = {1}, .critic = {}});
  const float parameters[] = {1, -1, 0.5F, 2, 0.25F, 1, 1, 3, -1};
  std::copy(std::begin(parameters), std::end(parameters), policy.parameters().begin());
  policy.normaliser = {Eigen::Vector2d(1, 2), Eigen::Vector2d(4, 0.25), 10, 1.5};
  const std::vector<float> observation = {2, 5};  // 0.5; 6, clipped to 1.5
  EXPECT_NEAR(policy.act(observation)[0], 2 * std::tanh(0.5 - 1.5 + 0.5) + 0.25, 1e-6);
  EXPECT_NEAR(policy.value(observation), 0.5 + 1.5 + 3, 1e-6);
  EXPECT_EQ(policy.log_std()[0], -1);
}

TEST(Policy, ComesBackFromItsTensors) {
  for (const Activation activation : {Activation::tanh, Activation::relu}) {
    for (const std::vector<int>& hidden : {std::vector<int>{}, {7}, {7, 3, 5}}) {
      const Policy policy = random_policy({4, 2, hidden, {6}, activation});
      TensorSet set = policy.tensors();
      set.tensors["adam.first"] = {{1}, std::vector<float>{1}};  // of others: left out
      const auto back = Policy::from(set);
      ASSERT_TRUE(back) << back.error().what;
      EXPECT_EQ(back->shape(), policy.shape());
      EXPECT_EQ(back->tensors(), policy.tensors());
      EXPECT_EQ(back->normaliser, policy.normaliser);
    }
  }
}

TEST(Policy, FaultyTensorsAreNamed) {
  const TensorSet good = random_policy({4, 2, {7}, {6}, Activation::tanh}).tensors();
  for (const auto& [name, tensor] : good.tensors) {
    const auto expect_named = [&](const Tensor* faulty) {
      TensorSet set = good;
      set.tensors.erase(name);
      if (faulty != nullptr) set.tensors[name] = *faulty;
      const auto policy = Policy::from(set);
      ASSERT_FALSE(policy) << name;
      EXPECT_EQ(policy.error().code, Errc::bad_input);
      // Without its last layer a net looks like another one, whose sizes do not fit.
      if (name.ends_with("1.weight")) return;
      EXPECT_THAT(policy.error().what, HasSubstr("\"" + name + "\""));
    };
    expect_named(nullptr);
    const Tensor whole_numbers = {tensor.shape, std::vector<std::int64_t>{1}};
    expect_named(&whole_numbers);
    const Tensor empty = {{0}, std::vector<float>{}};
    expect_named(&empty);
    Tensor long_shape = tensor;
    long_shape.shape.push_back(1);
    expect_named(&long_shape);
    Tensor huge = tensor;
    huge.shape.assign(2, std::int64_t{1} << 40);
    expect_named(&huge);
    Tensor nan = tensor;
    std::visit(
        [](auto& values) {
          values[0] = static_cast<std::remove_reference_t<decltype(values[0])>>(NAN);
        },
        nan.values);
    expect_named(&nan);
  }
}

TEST(Policy, ValuesOutOfRangeAreRefused) {
  const TensorSet good = random_policy({4, 2, {7}, {6}, Activation::tanh}).tensors();
  for (const char* name : {"normaliser.variance", "normaliser.count", "normaliser.clip"}) {
    TensorSet set = good;
    std::get<std::vector<double>>(set.tensors[name].values)[0] = -1;
    const auto policy = Policy::from(set);
    ASSERT_FALSE(policy);
    EXPECT_THAT(policy.error().what, HasSubstr(name));
  }
  for (const char* activation : {"", "elu"}) {
    TensorSet set = good;
    set.metadata["activation"] = activation;
    const auto policy = Policy::from(set);
    ASSERT_FALSE(policy);
    EXPECT_THAT(policy.error().what, HasSubstr("tanh | relu"));
  }
}

}  // namespace
}  // namespace mjarm::rl
