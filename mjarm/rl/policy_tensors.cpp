#include <algorithm>

#include "mjarm/core/messages/rl.hpp"
#include "mjarm/rl/policy.hpp"
#include "mjarm/rl/tensor_reader_internal.hpp"

namespace mjarm::rl {
namespace {

using detail::read_scalar;
using detail::read_tensor;
using detail::TensorShape;

TensorShape shape_of(const ParameterBlock& block) {
  if (block.cols == 1 && !block.name.ends_with(".weight")) return {block.rows};
  return {block.rows, block.cols};
}

/// Rows of the weights of all layers of a net whose sizes fit each other.
/// @param inputs  of the first layer; below 0: as many as there are.
Result<std::vector<int>> rows_of_layers(const TensorSet& set, const std::string& net,
                                        std::int64_t inputs) {
  constexpr std::int64_t kMaxRows = 1 << 20;
  std::vector<int> rows;
  for (;;) {
    const std::string name = net + "." + std::to_string(rows.size()) + ".weight";
    const auto found = set.tensors.find(name);
    if (found == set.tensors.end()) break;
    const TensorShape& shape = found->second.shape;
    const bool fits = shape.size() == 2 && std::ranges::all_of(shape, [](std::int64_t size) {
                        return size > 0 && size <= kMaxRows;
                      });
    if (!fits) {
      return fail(Errc::bad_input,
                  text(msg::rl_tensor_shape, name, detail::shape_text(shape), "(outputs, inputs)"));
    }
    if (inputs < 0) inputs = shape[1];
    auto values = read_tensor<float>(set, name, {shape[0], inputs});
    if (!values) return fail(std::move(values.error()));
    inputs = shape[0];
    rows.push_back(static_cast<int>(inputs));
  }
  if (rows.empty()) return fail(Errc::bad_input, text(msg::rl_no_tensor, net + ".0.weight"));
  return rows;
}

Result<PolicyShape> read_shape(const TensorSet& set) {
  PolicyShape shape;
  auto actor = rows_of_layers(set, "actor", -1);
  if (!actor) return fail(std::move(actor.error()));
  shape.observations = static_cast<int>(set.tensors.at("actor.0.weight").shape[1]);
  auto critic = rows_of_layers(set, "critic", shape.observations);
  if (!critic) return fail(std::move(critic.error()));
  shape.actions = actor->back();
  shape.actor.assign(actor->begin(), actor->end() - 1);
  shape.critic.assign(critic->begin(), critic->end() - 1);
  const auto activation = set.metadata.find("activation");
  const std::string word = activation == set.metadata.end() ? "" : activation->second;
  if (word != name(Activation::tanh) && word != name(Activation::relu)) {
    return fail(Errc::bad_input, text(msg::rl_metadata, "activation", word, "tanh | relu"));
  }
  shape.activation = word == name(Activation::tanh) ? Activation::tanh : Activation::relu;
  return shape;
}

Result<void> read_parameters(const TensorSet& set, Policy& policy) {
  for (const ParameterBlock& block : policy.blocks()) {
    auto values = read_tensor<float>(set, block.name, shape_of(block));
    if (!values) return fail(std::move(values.error()));
    std::ranges::copy(*values, policy.parameters().begin() + static_cast<long>(block.offset));
  }
  return {};
}

/// An error where `value` lies below `least`, or on it where that is not allowed.
Result<void> check_least(const std::string& name, double value, bool zero_too) {
  if (value > 0 || (zero_too && value == 0)) return {};
  const Msg expected = zero_too ? msg::rl_not_negative : msg::rl_positive;
  return fail(Errc::bad_input, text(msg::rl_tensor_value, name, value, text(expected)));
}

Result<void> read_normaliser(const TensorSet& set, Normaliser& normaliser) {
  const TensorShape shape = {normaliser.mean.size()};
  auto mean = read_tensor<double>(set, "normaliser.mean", shape);
  if (!mean) return fail(std::move(mean.error()));
  auto variance = read_tensor<double>(set, "normaliser.variance", shape);
  if (!variance) return fail(std::move(variance.error()));
  auto count = read_scalar<double>(set, "normaliser.count");
  if (!count) return fail(std::move(count.error()));
  auto clip = read_scalar<double>(set, "normaliser.clip");
  if (!clip) return fail(std::move(clip.error()));
  std::ranges::copy(*mean, normaliser.mean.begin());
  std::ranges::copy(*variance, normaliser.variance.begin());
  normaliser.count = *count;
  normaliser.clip = *clip;
  return check_least("normaliser.variance", normaliser.variance.minCoeff(), true)
      .and_then([&] { return check_least("normaliser.count", *count, true); })
      .and_then([&] { return check_least("normaliser.clip", *clip, false); });
}

}  // namespace

TensorSet Policy::tensors() const {
  TensorSet set;
  for (const ParameterBlock& block : blocks_) {
    const auto first = parameters_.begin() + static_cast<long>(block.offset);
    set.tensors[block.name] = {shape_of(block),
                               std::vector<float>(first, first + long{block.rows} * block.cols)};
  }
  const auto vector = [](const Eigen::VectorXd& x) {
    return detail::vector_tensor(std::vector<double>(x.begin(), x.end()));
  };
  set.tensors["normaliser.mean"] = vector(normaliser.mean);
  set.tensors["normaliser.variance"] = vector(normaliser.variance);
  set.tensors["normaliser.count"] = detail::scalar_tensor(normaliser.count);
  set.tensors["normaliser.clip"] = detail::scalar_tensor(normaliser.clip);
  set.metadata["activation"] = name(shape_.activation);
  return set;
}

Result<Policy> Policy::from(const TensorSet& set) {
  auto shape = read_shape(set);
  if (!shape) return fail(std::move(shape.error()));
  Policy policy(std::move(*shape));
  if (auto read = read_parameters(set, policy); !read) return fail(std::move(read.error()));
  if (auto read = read_normaliser(set, policy.normaliser); !read) {
    return fail(std::move(read.error()));
  }
  return policy;
}

}  // namespace mjarm::rl
