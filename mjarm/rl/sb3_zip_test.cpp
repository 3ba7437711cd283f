#include "mjarm/rl/sb3_zip.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "mjarm/core/file.hpp"
#include "mjarm/rl/policy_file_test.hpp"
#include "mjarm/rl/sb3_file_test.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm::rl {
namespace {

using nlohmann::json;
using testing::expect_refused;
using testing::PlantedTensor;
using testing::ZipEntry;

constexpr std::int32_t kHuge = 2147483647;

std::string bytes_of(const std::string& name) {
  return read_file(testing::test_file(name + ".zip")).value();
}

std::string floats(const std::vector<float>& values) {
  std::string out;
  for (const float value : values) append_little(out, value);
  return out;
}

/// The smallest policy: two observations, one action, one hidden layer of three.
std::vector<PlantedTensor> small_state() {
  const auto matrix = [](const std::string& name, int rows, int cols) {
    return PlantedTensor{.name = name + ".weight",
                         .shape = {rows, cols},
                         .strides = {cols, 1},
                         .count = rows * cols,
                         .storage = name + "w"};
  };
  const auto vector = [](const std::string& name, int size, const std::string& storage) {
    return PlantedTensor{.name = name, .shape = {size}, .count = size, .storage = storage};
  };
  return {vector("log_std", 1, "ls"),
          matrix("mlp_extractor.policy_net.0", 3, 2),
          vector("mlp_extractor.policy_net.0.bias", 3, "pb"),
          matrix("mlp_extractor.value_net.0", 3, 2),
          vector("mlp_extractor.value_net.0.bias", 3, "vb"),
          matrix("action_net", 1, 3),
          vector("action_net.bias", 1, "ab"),
          matrix("value_net", 1, 3),
          vector("value_net.bias", 1, "b")};
}

std::vector<ZipEntry> torch_entries(const std::vector<PlantedTensor>& state) {
  std::vector<ZipEntry> entries = {
      {.name = "archive/data.pkl", .content = testing::pickled_state(state)},
      {.name = "archive/byteorder", .content = "little"}};
  for (const PlantedTensor& tensor : state) {
    std::vector<float> values(static_cast<std::size_t>(std::max(tensor.count, 0)));
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = 0.25f * static_cast<float>(i + 1);
    entries.push_back({.name = "archive/data/" + tensor.storage, .content = floats(values)});
  }
  return entries;
}

std::string policy_around(const std::vector<ZipEntry>& torch, const std::string& data = "{}") {
  return testing::zip_of({{.name = "data", .content = data},
                          {.name = "policy.pth", .content = testing::zip_of(torch)}});
}

std::string policy_of(const std::vector<PlantedTensor>& state, const std::string& data = "{}") {
  return policy_around(torch_entries(state), data);
}

/// The smallest policy with one of its tensors changed.
template <class Change>
std::string policy_with(std::size_t index, const Change& change) {
  std::vector<PlantedTensor> state = small_state();
  change(state.at(index));
  return policy_of(state);
}

void expect_policy_refused(const std::string& bytes, const std::string& phrase) {
  SCOPED_TRACE(phrase);
  expect_refused(parse_sb3_zip(bytes, "f.zip"), "f.zip: ", phrase);
}

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
    const std::vector<double> action = testing::forward(*set, "actor", observation);
    for (std::size_t k = 0; k < action.size(); ++k, ++compared) {
      const double kept = std::clamp(action[k], double{low[k]}, double{high[k]});
      clipped += kept != action[k];
      EXPECT_NEAR(kept, truth[name]["actions"][i][k].get<double>(), 1e-5);
    }
    if (!truth[name].contains("values")) continue;
    const double value = testing::forward(*set, "critic", observation).at(0);
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

TEST(Sb3Zip, TensorsStayWithinTheirNumbers) {
  const auto planted = [](const auto& change, const std::string& phrase) {
    expect_policy_refused(policy_with(1, change), phrase);
  };
  const std::string beyond = "reaches beyond its numbers";
  planted([](auto& w) { w.strides = {-2, 1}; }, beyond);
  planted([](auto& w) { w.strides = {2, -1}; }, beyond);
  planted([](auto& w) { w.shape = {-3, 2}; }, beyond);
  planted([](auto& w) { w.offset = -1; }, beyond);
  planted([](auto& w) { w.offset = 1; }, beyond);
  planted([](auto& w) { w.offset = kHuge; }, beyond);
  planted([](auto& w) { w.strides = {3, 1}; }, beyond);
  planted([](auto& w) { w.shape = {4, 2}; }, beyond);
  planted([](auto& w) { w.shape = {kHuge, kHuge}, w.strides = {kHuge, kHuge}; }, beyond);
  planted([](auto& w) { w.shape = {3, 2, 1}, w.strides = {2, 1, 1}; }, "two dimensions");
  // Strides of 0 take few bytes in the file, and could take all memory.
  planted([](auto& w) { w.shape = {kHuge, kHuge}, w.strides = {0, 0}; }, "67108864 numbers");
  planted([](auto& w) { w.shape = {1 << 13, (1 << 13) + 1}, w.strides = {0, 0}; }, "67108864");
  planted([](auto& w) { w.shape = {0, 2}; }, "fits no layer");
  planted([](auto& w) { w.shape = {6}, w.strides = {1}; }, "fits no layer");

  std::vector<ZipEntry> torch = torch_entries(small_state());
  torch[3].content.pop_back();
  expect_policy_refused(policy_around(torch), "another size than 24 bytes");
  torch[3].content += "12345";
  expect_policy_refused(policy_around(torch), "another size than 24 bytes");
  torch.erase(torch.begin() + 3);
  expect_policy_refused(policy_around(torch), "missing");
  expect_policy_refused(policy_with(1, [](auto& w) { w.count = -6; }), "size than -24");
  std::vector<PlantedTensor> state = small_state();
  state[1].storage = "../../data";
  torch = torch_entries(small_state());
  torch[0].content = testing::pickled_state(state);
  expect_policy_refused(policy_around(torch), "missing");
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
  torch[2].content = floats({std::numeric_limits<float>::quiet_NaN()});
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
  refused("{\"a\":" + std::string(100000, '['), "not valid JSON");
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

TEST(Sb3Zip, DamagedArchivesGetOneLine) {
  const std::vector<ZipEntry> torch = torch_entries(small_state());
  const ZipEntry data{.name = "data", .content = "{}"};
  const ZipEntry policy{.name = "policy.pth", .content = testing::zip_of(torch)};
  const auto refused = [](const std::vector<ZipEntry>& entries, const std::string& phrase) {
    expect_policy_refused(testing::zip_of(entries), phrase);
  };
  const auto changed = [](ZipEntry entry, const auto& change) {
    change(entry);
    return entry;
  };
  ASSERT_TRUE(parse_sb3_zip(testing::zip_of({data, policy}), "f"));
  refused({}, "has no \"data\"");
  refused({data}, "has no \"policy.pth\"");
  refused({data, policy, data}, "\"data\" stands in it twice");
  refused({data, changed(policy, [](auto& e) { e.method = 8; })}, "is compressed");
  refused({data, changed(policy, [](auto& e) { e.flags = 1; })}, "compressed or encrypted");
  refused({data, changed(policy, [](auto& e) { e.wrong_crc = true; })}, "damaged (CRC-32)");
  refused({changed(data, [](auto& e) { e.wrong_crc = true; }), policy}, "damaged (CRC-32)");
  refused({data, changed(policy, [](auto& e) { e.size_off = 1; })}, "entry 2");
  refused({data, changed(policy, [](auto& e) { e.size_off = 4000000000; })}, "entry 2");
  refused({changed(data, [](auto& e) { e.local_off = 1; }), policy}, "entry 1");
  refused({changed(data, [](auto& e) { e.local_off = -1; }), policy}, "entry 1");
  refused({changed(data, [](auto& e) { e.local_off = 1 << 30; }), policy}, "entry 1");
  // A bomb: what is said to unpack to 4 GB is not unpacked at all.
  refused({data, changed(policy, [](auto& e) { e.method = 8, e.size_off = 0; })}, "compressed");
  expect_policy_refused("", "no whole zip archive");
  expect_policy_refused("PK\5\6", "no whole zip archive");
  expect_policy_refused(std::string(100, 'x'), "no whole zip archive");
  expect_policy_refused(testing::zip_of({data, policy}) + "x", "no whole zip archive");
  expect_policy_refused("x" + testing::zip_of({data, policy}), "entry 1");
  // Within policy.pth.
  const auto inner = [&](const std::string& content, const std::string& phrase) {
    refused({data, {.name = "policy.pth", .content = content}}, phrase);
  };
  inner("\x80\x02N.", "policy.pth: is no whole zip archive");
  inner(testing::zip_of({}), "has no \"data.pkl\"");
  std::vector<ZipEntry> more = torch;
  more.push_back({.name = "other/data.pkl", .content = "."});
  inner(testing::zip_of(more), "has no \"data.pkl\"");
  more = torch;
  more[1].content = "big";
  inner(testing::zip_of(more), "not little-endian");
  more = torch;
  more[2].method = 8;
  inner(testing::zip_of(more), "missing or have another size");
  more = torch;
  more[0].content =
      "\x80\x02" + testing::global("os", "system") + "(" + testing::unicode("touch owned") + "tR.";
  inner(testing::zip_of(more), "refused: data.pkl asks for \"os.system\"");
}

TEST(Sb3Zip, IsRefusedCutOffAnywhere) {
  const std::string whole = bytes_of("sb3_tanh");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    SCOPED_TRACE(size);
    expect_refused(parse_sb3_zip(std::string_view(whole).substr(0, size), "f"), "f: ");
  }
  const std::string torch = testing::zip_of(torch_entries(small_state()));
  for (std::size_t size = 0; size < torch.size(); ++size) {
    SCOPED_TRACE(size);
    const std::string policy =
        testing::zip_of({{.name = "data", .content = "{}"},
                         {.name = "policy.pth", .content = torch.substr(0, size)}});
    expect_refused(parse_sb3_zip(policy, "f"), "f: ");
  }
}

TEST(Sb3Zip, ByteFlipsChangeNothingOrAreSeen) {
  const std::string whole = bytes_of("sb3_tanh");
  const TensorSet truth = parse_sb3_zip(whole, "f").value();
  std::mt19937_64 random(3);
  int seen = 0;
  for (int round = 0; round < 20000; ++round) {
    std::string bytes = whole;
    bytes[random() % bytes.size()] ^= static_cast<char>(1 + random() % 255);
    const auto read = parse_sb3_zip(bytes, "f");
    if (read) {
      EXPECT_EQ(read->tensors, truth.tensors);
      EXPECT_EQ(read->metadata.at("activation"), truth.metadata.at("activation"));
    } else {
      expect_refused(read, "f: ");
      ++seen;
    }
  }
  EXPECT_GT(seen, 10000);
}

TEST(Sb3Zip, ByteFlipsBehindTheChecksumGiveWholeTensorsOrOneLine) {
  const std::string torch = testing::zip_of(torch_entries(small_state()));
  std::mt19937_64 random(4);
  int accepted = 0;
  for (int round = 0; round < 20000; ++round) {
    std::string bytes = torch;
    bytes[random() % bytes.size()] ^= static_cast<char>(1 + random() % 255);
    const auto read = parse_sb3_zip(testing::zip_of({{.name = "data", .content = "{}"},
                                                     {.name = "policy.pth", .content = bytes}}),
                                    "f");
    if (!read) {
      expect_refused(read, "f: ");
      continue;
    }
    ++accepted;
    testing::expect_whole(*read);
    EXPECT_EQ(testing::forward(*read, "actor", {1, 2}).size(), 1u);
  }
  EXPECT_GT(accepted, 0);  // weights may be others
}

}  // namespace
}  // namespace mjarm::rl
