#include "mjarm/rl/onnx_export.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>

#include "mjarm/rl/policy_file_test.hpp"
#include "mjarm/rl/protobuf_fields_test.hpp"
#include "mjarm/rl/sb3_zip.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::rl {
namespace {

using testing::all_of;
using testing::expect_refused;
using testing::only;

TensorSet random_actor(std::vector<int> sizes, const std::string& activation, bool normalised) {
  std::mt19937_64 random(8);
  std::normal_distribution<float> number;
  TensorSet set;
  const auto draw = [&](int count) {
    std::vector<float> values(static_cast<std::size_t>(count));
    for (float& value : values) value = 0.5f * number(random);
    return values;
  };
  for (std::size_t i = 1; i < sizes.size(); ++i) {
    const std::string name = "actor." + std::to_string(i - 1);
    set.tensors[name + ".weight"] = {{sizes[i], sizes[i - 1]}, draw(sizes[i] * sizes[i - 1])};
    set.tensors[name + ".bias"] = {{sizes[i]}, draw(sizes[i])};
  }
  const auto inputs = static_cast<std::size_t>(sizes[0]);
  std::vector<double> mean(inputs), variance(inputs);
  for (std::size_t i = 0; i < inputs; ++i) {
    mean[i] = number(random);
    variance[i] = 0.01 + 0.2 * static_cast<double>(i);
  }
  set.tensors["normaliser.mean"] = {{sizes[0]}, mean};
  set.tensors["normaliser.variance"] = {{sizes[0]}, variance};
  set.tensors["normaliser.count"] = {{}, std::vector{normalised ? 1000.0 : 0.0}};
  set.tensors["normaliser.clip"] = {{}, std::vector{2.5}};
  set.metadata["activation"] = activation;
  return set;
}

/// The oracle, in double precision: (x - mean) / sqrt(variance + 1e-8), clipped, then the layers.
std::vector<double> expected_action(const TensorSet& set, std::vector<double> x) {
  const auto numbers = [&](const char* name) {
    return std::get<std::vector<double>>(set.tensors.at(name).values);
  };
  const double clip = numbers("normaliser.clip")[0];
  for (std::size_t i = 0; numbers("normaliser.count")[0] > 0 && i < x.size(); ++i) {
    const double scaled = (x[i] - numbers("normaliser.mean")[i]) /
                          std::sqrt(numbers("normaliser.variance")[i] + 1e-8);
    x[i] = std::clamp(scaled, -clip, clip);
  }
  return testing::forward_pass(set, "actor", x);
}

struct OnnxNode {
  std::string type;
  std::vector<std::string> inputs;
  std::string output;
};

std::vector<OnnxNode> nodes_of(std::string_view graph) {
  std::vector<OnnxNode> nodes;
  for (const auto& field : all_of(graph, 1)) {
    OnnxNode node{.type = std::string(only(field.bytes, 4).bytes),
                  .inputs = {},
                  .output = std::string(only(field.bytes, 2).bytes)};
    for (const auto& input : all_of(field.bytes, 1)) node.inputs.emplace_back(input.bytes);
    if (node.type == "Gemm") {
      const auto attribute = only(field.bytes, 5).bytes;
      EXPECT_EQ(only(attribute, 1).bytes, "transB");
      EXPECT_EQ(only(attribute, 3).integer, 1u);
      EXPECT_EQ(only(attribute, 20).integer, 2u);
    } else {
      EXPECT_TRUE(all_of(field.bytes, 5).empty());
    }
    nodes.push_back(node);
  }
  return nodes;
}

/// Name and width of an input or an output, float32 (batch, width).
std::pair<std::string, std::uint64_t> port_of(std::string_view port) {
  const auto tensor = only(only(port, 2).bytes, 1).bytes;
  EXPECT_EQ(only(tensor, 1).integer, 1u);
  const auto dims = all_of(only(tensor, 2).bytes, 1);
  EXPECT_EQ(dims.size(), 2u);
  EXPECT_EQ(only(dims.at(0).bytes, 2).bytes, "batch");
  return {std::string(only(port, 1).bytes), only(dims.at(1).bytes, 1).integer};
}

TEST(OnnxExport, HasTheStructureThatOnnxWants) {
  const TensorSet set = random_actor({5, 7, 3, 2}, "tanh", true);
  const std::string bytes = to_onnx(set).value();
  EXPECT_EQ(to_onnx(set).value(), bytes);
  EXPECT_EQ(only(bytes, 1).integer, 8u);
  EXPECT_EQ(only(bytes, 2).bytes, "mjarm");
  EXPECT_EQ(only(only(bytes, 8).bytes, 1).bytes, "");
  EXPECT_EQ(only(only(bytes, 8).bytes, 2).integer, 17u);
  const auto graph = only(bytes, 7).bytes;
  EXPECT_FALSE(only(graph, 2).bytes.empty());
  EXPECT_EQ(port_of(only(graph, 11).bytes),
            std::pair(std::string("observation"), std::uint64_t{5}));
  EXPECT_EQ(port_of(only(graph, 12).bytes), std::pair(std::string("action"), std::uint64_t{2}));

  std::map<std::string, std::vector<float>> constants;
  for (const auto& tensor : all_of(graph, 5)) {
    std::size_t count = 1;
    for (const auto& size : all_of(tensor.bytes, 1)) count *= size.integer;
    EXPECT_EQ(only(tensor.bytes, 2).integer, 1u);
    const auto raw = only(tensor.bytes, 9).bytes;
    ASSERT_EQ(raw.size(), 4 * count);
    auto& values = constants[std::string(only(tensor.bytes, 8).bytes)];
    for (std::size_t i = 0; i < count; ++i) values.push_back(load_little<float>(raw, 4 * i));
  }
  const auto same = [&](const char* name) {
    EXPECT_EQ(constants.at(name), std::get<std::vector<float>>(set.tensors.at(name).values));
  };
  for (const char* name : {"actor.0.weight", "actor.0.bias", "actor.2.weight", "actor.2.bias"}) {
    same(name);
  }
  EXPECT_EQ(constants.at("most"), std::vector{2.5f});

  // One chain from the input to the output; every other input is a constant.
  std::string last = "observation", types;
  for (const OnnxNode& node : nodes_of(graph)) {
    EXPECT_EQ(node.inputs.at(0), last);
    for (std::size_t i = 1; i < node.inputs.size(); ++i) {
      EXPECT_TRUE(constants.contains(node.inputs[i])) << node.inputs[i];
    }
    last = node.output;
    types += node.type + " ";
  }
  EXPECT_EQ(last, "action");
  EXPECT_EQ(types, "Sub Mul Clip Gemm Tanh Gemm Tanh Gemm ");
}

TEST(OnnxExport, LeavesOutANormaliserThatDoesNothing) {
  TensorSet set = random_actor({4, 3}, "relu", false);
  const std::string bytes = to_onnx(set).value();
  EXPECT_EQ(nodes_of(only(bytes, 7).bytes).size(), 1u);
  for (const char* name : {"mean", "variance", "count", "clip"}) {
    set.tensors.erase(std::string("normaliser.") + name);
  }
  EXPECT_EQ(to_onnx(set).value(), bytes);
}

TEST(OnnxExport, NamesTheTensorThatDoesNotFit) {
  const TensorSet good = random_actor({5, 7, 2}, "relu", true);
  for (const char* name : {"actor.0.weight", "actor.0.bias", "actor.1.bias", "normaliser.mean",
                           "normaliser.variance", "normaliser.clip"}) {
    TensorSet set = good;
    set.tensors.erase(name);
    expect_refused(to_onnx(set), "no ONNX file", name);
    set.tensors[name] = {{1, 3}, std::vector{1.f, 2.f, 3.f}};
    expect_refused(to_onnx(set), "no ONNX file", "\"");
  }
  TensorSet set = good;
  set.metadata["activation"] = "gelu";
  expect_refused(to_onnx(set), "no ONNX file", "\"gelu\"");
  set.metadata.clear();
  expect_refused(to_onnx(set), "no ONNX file", "activation");
}

/// A Python with onnxruntime: MJARM_TEST_PYTHON names it, else the environment of the peers may be
/// one. None where there is none.
std::optional<std::filesystem::path> python_with_onnxruntime() {
  const char* named = std::getenv("MJARM_TEST_PYTHON");
  if (named != nullptr && *named != '\0') return named;
  const std::filesystem::path peers = std::filesystem::path(MJARM_VENV) / "bin" / "python";
  if (!std::filesystem::exists(peers)) return std::nullopt;
  const auto asked = support::run_program(peers, {"-c", "import onnx, onnxruntime"});
  return asked.exit_code == 0 ? std::optional(peers) : std::nullopt;
}

TEST(OnnxExport, ActsTheSameInOnnxruntime) {
  if (!support::kStartsPrograms) GTEST_SKIP() << "tests start no programs on Windows so far";
  const auto python = python_with_onnxruntime();
  if (!python) {
    GTEST_SKIP() << "needs a Python with onnx and onnxruntime: MJARM_TEST_PYTHON names none, and "
                    ".venv has neither";
  }
  const support::TempFolder folder;
  for (const TensorSet& set :
       {random_actor({24, 64, 64, 7}, "tanh", true), random_actor({3, 5, 2}, "relu", false),
        random_actor({6, 1}, "relu", true)}) {
    const auto inputs = static_cast<std::size_t>(set.tensors.at("actor.0.weight").shape[1]);
    std::mt19937_64 random(9);
    std::normal_distribution<float> number(0, 2);
    std::vector<std::vector<float>> observations(50, std::vector<float>(inputs));
    for (auto& observation : observations) {
      for (float& value : observation) value = number(random);
    }
    const auto data = folder.write("observations.json", nlohmann::json(observations).dump());
    const auto model = folder.path() / "policy.onnx";
    ASSERT_TRUE(save_onnx(model, set));
    const auto run = support::run_program(
        *python, {testing::test_file("run_onnx.py").string(), model.string(), data.string()});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto actions = nlohmann::json::parse(run.out).get<std::vector<std::vector<double>>>();
    ASSERT_EQ(actions.size(), observations.size());
    for (std::size_t i = 0; i < actions.size(); ++i) {
      const auto expected = expected_action(set, {observations[i].begin(), observations[i].end()});
      ASSERT_EQ(actions[i].size(), expected.size());
      for (std::size_t k = 0; k < expected.size(); ++k) {
        EXPECT_NEAR(actions[i][k], expected[k], 1e-5);
      }
    }
  }
}

TEST(OnnxExport, OfAPolicyOfStableBaselines) {
  const TensorSet set = load_sb3_zip(testing::test_file("sb3_relu.zip")).value();
  const std::string bytes = to_onnx(set).value();
  EXPECT_EQ(nodes_of(only(bytes, 7).bytes).size(), 7u);
}

}  // namespace
}  // namespace mjarm::rl
