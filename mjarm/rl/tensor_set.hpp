#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace mjarm::rl {

/// Numbers of one type in row-major order.
struct Tensor {
  std::vector<std::int64_t> shape;  ///< product = number of values; empty for a scalar
  std::variant<std::vector<float>, std::vector<double>, std::vector<std::int64_t>> values;

  [[nodiscard]] bool operator==(const Tensor&) const = default;
};

/// What a checkpoint file holds: named tensors, and texts about them.
struct TensorSet {
  std::map<std::string, Tensor> tensors;
  std::map<std::string, std::string> metadata;

  [[nodiscard]] bool operator==(const TensorSet&) const = default;
};

}  // namespace mjarm::rl
