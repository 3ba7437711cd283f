#include <cmath>

#include "mjarm/core/messages/rl.hpp"
#include "mjarm/rl/tensor_reader_internal.hpp"

namespace mjarm::rl::detail {
namespace {

template <class T>
std::string_view type_name() {
  if (std::is_same_v<T, float>) return "float32";
  return std::is_same_v<T, double> ? "float64" : "int64";
}

std::size_t count_of(const TensorShape& shape) {
  std::size_t count = 1;
  for (const std::int64_t size : shape) count *= static_cast<std::size_t>(size);
  return count;
}

}  // namespace

std::string shape_text(const TensorShape& shape) {
  std::string out = "(";
  for (const std::int64_t size : shape) {
    if (out.size() > 1) out += ", ";
    out += std::to_string(size);
  }
  return out + ")";
}

template <class T>
Result<std::span<const T>> read_tensor(const TensorSet& set, const std::string& name,
                                       const TensorShape& shape) {
  const auto found = set.tensors.find(name);
  if (found == set.tensors.end()) return fail(Errc::bad_input, text(msg::rl_no_tensor, name));
  const Tensor& tensor = found->second;
  const auto* values = std::get_if<std::vector<T>>(&tensor.values);
  if (values == nullptr) {
    return fail(Errc::bad_input, text(msg::rl_tensor_type, name, type_name<T>()));
  }
  if (tensor.shape != shape || values->size() != count_of(shape)) {
    return fail(Errc::bad_input,
                text(msg::rl_tensor_shape, name, shape_text(tensor.shape), shape_text(shape)));
  }
  for (const T value : *values) {
    if (!std::isfinite(static_cast<double>(value))) {
      return fail(Errc::bad_input, text(msg::rl_tensor_value, name, static_cast<double>(value),
                                        text(msg::rl_finite)));
    }
  }
  return std::span<const T>(*values);
}

template Result<std::span<const float>> read_tensor(const TensorSet&, const std::string&,
                                                    const TensorShape&);
template Result<std::span<const double>> read_tensor(const TensorSet&, const std::string&,
                                                     const TensorShape&);
template Result<std::span<const std::int64_t>> read_tensor(const TensorSet&, const std::string&,
                                                           const TensorShape&);

}  // namespace mjarm::rl::detail
