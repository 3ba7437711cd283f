#include "mjarm/rl/sb3_zip.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "mjarm/core/file.hpp"
#include "mjarm/rl/policy_file_test.hpp"
#include "mjarm/rl/sb3_file_test.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm::rl {
namespace {

using nlohmann::json;
using testing::expect_policy_refused;
using testing::expect_refused;
using testing::float_bytes;
using testing::PlantedTensor;
using testing::policy_around;
using testing::policy_of;
using testing::policy_with;
using testing::small_state;
using testing::torch_entries;
using testing::ZipEntry;

class Sb3Policy : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Files, Sb3Policy,
                         ::testing::Values("sb3_tanh", "sb3_relu", "sb3_shared", "sb3_flat"));

TEST_P(Sb3Policy, ActsAsStableBaselinesDoes) {
  const std::string name = GetParam();
  const auto set = load_sb3_zip(testing::test_file(name + ".zip"));
  ASSERT_TRUE(set) << set.error().what;
  testing::expect_whole(*set);
  const json truth = support::load_json(testing::test_file("sb3_actions.json"));
  const auto& low = std::get<std::vector<float>>(set->tensors.at("action.low").values);
  const auto& high = std::get<std::vector<float>>(set->tensors.at("action.high").values);
  EXPECT_EQ(low, truth["low"].get<std::vector<float>>());
  EXPECT_EQ(high, truth["high"].get<std::vector<float>>());
  int clipped = 0, compared = 0;
  for (std::size_t i = 0; i < truth["observations"].size(); ++i) {
    const auto observation = truth["observations"][i].get<std::vector<double>>();
    const std::vector<double> action = testing::forward_pass(*set, "actor", observation);
    for (std::size_t k = 0; k < action.size(); ++k, ++compared) {
      const double kept = std::clamp(action[k], double{low[k]}, double{high[k]});
      clipped += kept != action[k];
      EXPECT_NEAR(kept, truth[name]["actions"][i][k].get<double>(), 1e-5);
    }
    if (!truth[name].contains("values")) continue;
    const double value = testing::forward_pass(*set, "critic", observation).at(0);
    EXPECT_NEAR(value, truth[name]["values"][i].get<double>(), 1e-5);
  }
  EXPECT_GT(clipped, 0);
  EXPECT_LT(clipped, compared);
}

TEST(Sb3Zip, NamesAreThoseOfAPolicy) {
  const TensorSet set = load_sb3_zip(testing::test_file("sb3_relu.zip")).value();
  std::vector<std::string> names;
  for (const auto& [name, tensor] : set.tensors) names.push_back(name);
  EXPECT_EQ(names, (std::vector<std::string>{
                       "action.high", "action.low", "actor.0.bias", "actor.0.weight",
                       "actor.1.bias", "actor.1.weight", "actor.2.bias", "actor.2.weight",
                       "actor.3.bias", "actor.3.weight", "critic.0.bias", "critic.0.weight",
                       "critic.1.bias", "critic.1.weight", "log_std", "normaliser.clip",
                       "normaliser.count", "normaliser.mean", "normaliser.variance"}));
  EXPECT_EQ(set.metadata.at("activation"), "relu");
  EXPECT_EQ(set.metadata.at("source"), "stable-baselines3 2.9.2");
  EXPECT_EQ(set.tensors.at("actor.1.weight").shape, (std::vector<std::int64_t>{6, 8}));
  EXPECT_EQ(std::get<std::vector<double>>(set.tensors.at("normaliser.count").values)[0], 0);
  const TensorSet shared = load_sb3_zip(testing::test_file("sb3_shared.zip")).value();
  EXPECT_EQ(shared.tensors.at("actor.0.weight"), shared.tensors.at("critic.0.weight"));
  EXPECT_NE(shared.tensors.at("actor.1.weight"), shared.tensors.at("critic.1.weight"));
  EXPECT_EQ(shared.metadata.at("source"), "stable-baselines3 1.8.0");
}

TEST(Sb3Zip, StateDependentExplorationIsRefused) {
  const std::string path = testing::test_file("sb3_sde.zip").string();
  expect_refused(load_sb3_zip(path), path, "use_sde");
  expect_refused(load_sb3_zip("/no/such.zip"), "/no/such.zip");
}

TEST(Sb3Zip, WhatTheTestsWriteIsRead) {
  const auto set = parse_sb3_zip(policy_of(small_state()), "f.zip");
  ASSERT_TRUE(set) << set.error().what;
  EXPECT_EQ(set->metadata.at("activation"), "tanh");
  EXPECT_FALSE(set->tensors.contains("action.low"));
  // A matrix that was turned, and one that begins within its storage.
  std::vector<PlantedTensor> state = small_state();
  state[1].strides = {1, 3};
  state[3] = {.name = state[3].name, .shape = {3, 2}, .strides = {2, 1}, .offset = 1, .count = 9};
  const auto turned = parse_sb3_zip(policy_of(state), "f.zip");
  ASSERT_TRUE(turned) << turned.error().what;
  EXPECT_EQ(std::get<std::vector<float>>(turned->tensors.at("actor.0.weight").values),
            (std::vector{0.25f, 1.f, 0.5f, 1.25f, 0.75f, 1.5f}));
  EXPECT_EQ(std::get<std::vector<float>>(turned->tensors.at("critic.0.weight").values),
            (std::vector{0.5f, 0.75f, 1.f, 1.25f, 1.5f, 1.75f}));
}

TEST(Sb3Zip, LayersMustMakeAnActorAndACritic) {
  const auto renamed = [](std::size_t index, const std::string& name, const std::string& phrase) {
    expect_policy_refused(policy_with(index, [&](auto& tensor) { tensor.name = name; }), phrase);
  };
  renamed(0, "log_std2", "tensor \"log_std\" is missing");
  renamed(2, "x", "\"mlp_extractor.policy_net.0.bias\" is missing");
  renamed(5, "x", "\"action_net.weight\" is missing");
  renamed(6, "x\ny", "\"action_net.bias\" is missing");
  renamed(7, "x", "\"value_net.weight\" is missing");
  std::vector<PlantedTensor> state = small_state();
  for (const char* name : {"features_extractor.cnn.0.weight", "mlp_extractor.policy_net.1.weight",
                           "mlp_extractor.policy_net.4.weight", "actor.mu.weight", ""}) {
    state.resize(9);
    state.push_back({.name = name});
    expect_policy_refused(policy_of(state), "belongs to no actor and critic");
  }
  const auto resized = [](std::size_t index, std::vector<std::int32_t> shape) {
    expect_policy_refused(policy_with(index,
                                      [&](auto& tensor) {
                                        tensor.count = 1;
                                        tensor.strides.assign(shape.size(), 1);
                                        for (const std::int32_t n : shape) tensor.count *= n;
                                        if (shape.size() == 2) tensor.strides[0] = shape[1];
                                        tensor.shape = shape;
                                      }),
                          "fits no layer");
  };
  resized(0, {2});
  resized(1, {3, 4});
  resized(2, {2});
  resized(3, {3, 3});
  resized(5, {1, 4});
  resized(6, {2});
  resized(6, {});
  resized(7, {2, 3});
  std::vector<ZipEntry> torch = torch_entries(small_state());
  torch[2].content = float_bytes({std::numeric_limits<float>::quiet_NaN()});
  expect_policy_refused(policy_around(torch), "\"log_std\" holds a number that is not finite");
}

TEST(Sb3Zip, TheDataDecidesHowLayersAreUsed) {
  const auto activation = [](const std::string& data) {
    const auto set = parse_sb3_zip(policy_of(small_state(), data), "f.zip");
    return set ? set->metadata.at("activation") : set.error().what;
  };
  const auto of_class = [](const std::string& name) {
    return R"({"policy_kwargs":{"activation_fn":"<class 'torch.nn.modules.activation.)" + name +
           R"('>"}})";
  };
  EXPECT_EQ(activation(of_class("ReLU")), "relu");
  EXPECT_EQ(activation(of_class("Tanh")), "tanh");
  EXPECT_EQ(activation("{\"policy_kwargs\":{}}"), "tanh");
  EXPECT_EQ(activation("{\"policy_kwargs\":{\"net_arch\":\"[64, dict(pi=[64])]\"}}"), "tanh");
  EXPECT_EQ(activation("{\"policy_kwargs\":null,\"seed\":7}"), "tanh");
  // Python writes what JSON does not know.
  EXPECT_EQ(activation("{\"a\":[NaN,Infinity,-Infinity],\"b\":\"NaN \\\" Infinity\"}"), "tanh");
  const auto refused = [](const std::string& data, const std::string& phrase) {
    expect_policy_refused(policy_of(small_state(), data), phrase);
  };
  refused(of_class("ELU"), "activation_fn in its data is not supported");
  refused(of_class("LeakyReLU"), "LeakyReLU");
  refused("{\"policy_kwargs\":{\"squash_output\":true}}", "squash_output");
  refused("{\"policy_kwargs\":{\"features_extractor_class\":\"<class 'torch_layers.NatureCNN'>\"}}",
          "NatureCNN");
  refused("{\"observation_space\":{\":type:\":\"<class 'gym.spaces.dict.Dict'>\"}}", "dict.Dict");
  refused("{\"action_space\":{\":type:\":\"<class 'gym.spaces.discrete.Discrete'>\"}}", "Discrete");
  refused("", "\"data\" is not valid JSON");
  refused("{", "\"data\" is not valid JSON");
  refused("[]", "\"data\" is not a JSON object");
  refused("{\"a\":1,\"a\":2}", "twice");
  refused("{\"a\":" + std::string(100000, '[') + std::string(100000, ']') + "}", "deeper than 32");
  refused("{\"a\":" + std::string(100000, '['), "deeper than 32");
  refused("{\"a\":-NaN}", "not valid JSON");
}

TEST(Sb3Zip, BoundsOfActionsAreReadWhereTheyArePrinted) {
  const auto has_bounds = [](const std::string& low, const std::string& high) {
    const json space = {{":type:", "<class 'gym.spaces.box.Box'>"}, {"low", low}, {"high", high}};
    const auto set =
        parse_sb3_zip(policy_of(small_state(), json{{"action_space", space}}.dump()), "f.zip");
    EXPECT_TRUE(set) << set.error().what;
    return set->tensors.contains("action.low") && set->tensors.contains("action.high");
  };
  EXPECT_TRUE(has_bounds("[-1.]", "[1.]"));
  EXPECT_TRUE(has_bounds("[ -2.8973e+00\n]", "[ 2.5 ]"));
  EXPECT_FALSE(has_bounds("[-inf]", "[inf]"));
  EXPECT_FALSE(has_bounds("[-1. -1.]", "[1. 1.]"));
  EXPECT_FALSE(has_bounds("[-1.]", ""));
  EXPECT_FALSE(has_bounds("[1.]", "[-1.]"));
  EXPECT_FALSE(has_bounds("[one]", "[1.]"));
  EXPECT_FALSE(has_bounds("[]", "[]"));
  EXPECT_FALSE(has_bounds("[-1.x]", "[1.]"));
  EXPECT_FALSE(has_bounds("[", "]"));
}

}  // namespace
}  // namespace mjarm::rl
