#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/rl/tensor_set.hpp"

/// What the tests of files of policies share.
namespace mjarm::testing {

inline std::filesystem::path test_file(const std::string& name) {
  return std::filesystem::path(MJARM_RL_TESTDATA) / name;
}

/// A refusal is one line that names the file and holds `phrase`.
template <class T>
void expect_refused(const Result<T>& result, const std::string& source,
                    const std::string& phrase = "") {
  ASSERT_FALSE(result) << "accepted; expected: " << phrase;
  const Error& error = result.error();
  EXPECT_EQ(error.code, Errc::bad_input) << error.what;
  EXPECT_TRUE(error.what.starts_with(source)) << error.what;
  EXPECT_NE(error.what.find(phrase), std::string::npos) << error.what << "\nlacks: " << phrase;
  EXPECT_EQ(error.what.find('\n'), std::string::npos) << error.what;
  EXPECT_EQ(error.what.find("{}"), std::string::npos) << error.what;
  EXPECT_LT(error.what.size(), 400u) << error.what;
}

inline std::size_t value_count_of(const rl::Tensor& tensor) {
  return std::visit([](const auto& values) { return values.size(); }, tensor.values);
}

/// Every tensor has as many numbers as its shape says.
inline void expect_whole(const rl::TensorSet& set) {
  for (const auto& [name, tensor] : set.tensors) {
    const auto product = std::accumulate(tensor.shape.begin(), tensor.shape.end(), std::int64_t{1},
                                         std::multiplies<>());
    EXPECT_EQ(static_cast<std::int64_t>(value_count_of(tensor)), product) << name;
  }
}

/// The oracle: a net of plain layers in double precision, without normaliser.
inline std::vector<double> forward_pass(const rl::TensorSet& set, const std::string& net,
                                        std::vector<double> x) {
  for (int layer = 0;; ++layer) {
    const std::string name = net + "." + std::to_string(layer);
    const rl::Tensor& weight = set.tensors.at(name + ".weight");
    const auto& w = std::get<std::vector<float>>(weight.values);
    const auto& bias = std::get<std::vector<float>>(set.tensors.at(name + ".bias").values);
    std::vector<double> y(bias.begin(), bias.end());
    for (std::size_t i = 0; i < y.size(); ++i) {
      for (std::size_t j = 0; j < x.size(); ++j) y[i] += double{w.at(i * x.size() + j)} * x[j];
    }
    if (!set.tensors.contains(net + "." + std::to_string(layer + 1) + ".weight")) return y;
    const bool relu = set.metadata.at("activation") == "relu";
    for (double& value : y) value = relu ? std::max(value, 0.0) : std::tanh(value);
    x = std::move(y);
  }
}

}  // namespace mjarm::testing
