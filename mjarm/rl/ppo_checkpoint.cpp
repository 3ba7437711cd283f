#include <algorithm>
#include <array>

#include "mjarm/core/messages/rl.hpp"
#include "mjarm/rl/tensor_reader_internal.hpp"
#include "mjarm/rl/trainer_state_internal.hpp"

namespace mjarm::rl {
namespace {

using detail::read_scalar;
using detail::read_tensor;
using detail::scalar_tensor;
using detail::vector_tensor;

using Words = std::array<std::uint64_t, 4>;

/// A vector of `to.size()` numbers into `to`.
template <class T>
Result<void> read_into(const TensorSet& set, const std::string& name, std::vector<T>& to) {
  auto values = read_tensor<T>(set, name, {static_cast<std::int64_t>(to.size())});
  if (!values) return fail(std::move(values.error()));
  std::ranges::copy(*values, to.begin());
  return {};
}

Result<void> read_into(const TensorSet& set, const std::string& name, std::int64_t& to) {
  auto value = read_scalar<std::int64_t>(set, name);
  if (!value) return fail(std::move(value.error()));
  if (*value < 0) {
    return fail(Errc::bad_input, text(msg::rl_tensor_value, name, static_cast<double>(*value),
                                      text(msg::rl_not_negative)));
  }
  to = *value;
  return {};
}

Result<Rng> read_rng(const TensorSet& set, const std::string& name) {
  std::vector<std::int64_t> values(4);
  if (auto read = read_into(set, name, values); !read) return fail(std::move(read.error()));
  Words words{};
  std::ranges::transform(values, words.begin(),
                         [](std::int64_t word) { return static_cast<std::uint64_t>(word); });
  if (words == Words{}) {
    return fail(Errc::bad_input, text(msg::rl_tensor_value, name, 0.0, text(msg::rl_not_all_zero)));
  }
  return Rng(words);
}

/// Mean, variance and count of one number.
Result<void> read_scale(const TensorSet& set, const std::string& name, Normaliser& scale) {
  std::vector<double> values(3);
  if (auto read = read_into(set, name, values); !read) return read;
  for (const double value : {values[1], values[2]}) {
    if (value >= 0) continue;
    return fail(Errc::bad_input,
                text(msg::rl_tensor_value, name, value, text(msg::rl_not_negative)));
  }
  scale.mean[0] = values[0];
  scale.variance[0] = values[1];
  scale.count = values[2];
  return {};
}

/// A policy that has the layers of `like`.
Result<Policy> read_policy(const TensorSet& set, const Policy& like) {
  const TensorSet ours = like.tensors();
  for (const ParameterBlock& block : like.blocks()) {
    auto values = read_tensor<float>(set, block.name, ours.tensors.at(block.name).shape);
    if (!values) return fail(std::move(values.error()));
  }
  auto policy = Policy::from(set);
  if (policy && policy->shape() != like.shape()) {
    return fail(Errc::bad_input, text(msg::rl_other_policy));
  }
  return policy;
}

}  // namespace

TensorSet PpoTrainer::checkpoint() const {
  const State& state = *state_;
  TensorSet set = state.policy.tensors();
  auto& tensors = set.tensors;
  tensors["adam.first"] = vector_tensor(state.adam.first);
  tensors["adam.second"] = vector_tensor(state.adam.second);
  tensors["adam.steps"] = scalar_tensor(state.adam.steps);
  std::vector<std::int64_t> words;
  for (const std::uint64_t word : state.rng.state()) {
    words.push_back(static_cast<std::int64_t>(word));
  }
  tensors["trainer.rng"] = vector_tensor(std::move(words));
  tensors["trainer.steps"] = scalar_tensor(state.steps);
  tensors["trainer.iterations"] = scalar_tensor(state.iterations);
  tensors["trainer.reward_scale"] = vector_tensor(std::vector<double>{
      state.reward_scale.mean[0], state.reward_scale.variance[0], state.reward_scale.count});
  tensors["trainer.open_returns"] = vector_tensor(state.open.returns);
  tensors["trainer.open_discounted"] = vector_tensor(state.open.discounted);
  tensors["trainer.open_lengths"] = vector_tensor(state.open.lengths);
  tensors["env.state"] = vector_tensor(state.env.state());
  return set;
}

Result<void> PpoTrainer::restore(const TensorSet& set) {
  State& state = *state_;
  auto policy = read_policy(set, state.policy);
  if (!policy) return fail(std::move(policy.error()));
  auto rng = read_rng(set, "trainer.rng");
  if (!rng) return fail(std::move(rng.error()));
  detail::Adam adam(state.policy.parameters().size());
  detail::OpenEpisodes open(state.env.count());
  Normaliser scale = state.reward_scale;
  std::int64_t steps = 0, iterations = 0;
  auto read =
      read_into(set, "adam.first", adam.first)
          .and_then([&] { return read_into(set, "adam.second", adam.second); })
          .and_then([&] { return read_into(set, "adam.steps", adam.steps); })
          .and_then([&] { return read_into(set, "trainer.steps", steps); })
          .and_then([&] { return read_into(set, "trainer.iterations", iterations); })
          .and_then([&] { return read_scale(set, "trainer.reward_scale", scale); })
          .and_then([&] { return read_into(set, "trainer.open_returns", open.returns); })
          .and_then([&] { return read_into(set, "trainer.open_discounted", open.discounted); })
          .and_then([&] { return read_into(set, "trainer.open_lengths", open.lengths); });
  if (!read) return read;
  const float least = *std::ranges::min_element(adam.second);
  if (least < 0) {
    return fail(Errc::bad_input, text(msg::rl_tensor_value, "adam.second", double(least),
                                      text(msg::rl_not_negative)));
  }
  // What an environment keeps is its own affair: of any length, and with any numbers.
  const auto found = set.tensors.find("env.state");
  if (found == set.tensors.end())
    return fail(Errc::bad_input, text(msg::rl_no_tensor, "env.state"));
  const auto* env_state = std::get_if<std::vector<double>>(&found->second.values);
  if (env_state == nullptr) {
    return fail(Errc::bad_input, text(msg::rl_tensor_type, "env.state", "float64"));
  }
  if (auto taken = state.env.set_state(*env_state); !taken) return taken;
  state.policy = std::move(*policy);
  state.adam = std::move(adam);
  state.rng = *rng;
  state.reward_scale = std::move(scale);
  state.open = std::move(open);
  state.steps = steps;
  state.iterations = iterations;
  state.networks.pack(state.policy);
  return {};
}

}  // namespace mjarm::rl
