#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/rl/tensor_set.hpp"

namespace mjarm::rl::detail {

using TensorShape = std::vector<std::int64_t>;

/// "(256, 24)"; "()" of a scalar.
[[nodiscard]] std::string shape_text(const TensorShape& shape);

/// The numbers of a tensor, for T float, double or std::int64_t.
/// @return an error that names the tensor where it is missing, of another type or shape, or holds a
///         number that is not finite.
template <class T>
[[nodiscard]] Result<std::span<const T>> read_tensor(const TensorSet& set, const std::string& name,
                                                     const TensorShape& shape);

/// One number of type double or std::int64_t.
template <class T>
[[nodiscard]] Result<T> read_scalar(const TensorSet& set, const std::string& name) {
  return read_tensor<T>(set, name, {}).map([](std::span<const T> values) { return values[0]; });
}

/// A tensor of one dimension.
template <class T>
[[nodiscard]] Tensor vector_tensor(std::vector<T> values) {
  return {{static_cast<std::int64_t>(values.size())}, std::move(values)};
}

template <class T>
[[nodiscard]] Tensor scalar_tensor(T value) {
  return {{}, std::vector<T>{value}};
}

}  // namespace mjarm::rl::detail
