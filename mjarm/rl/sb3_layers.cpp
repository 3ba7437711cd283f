#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <vector>

#include "mjarm/core/messages/policy_file.hpp"
#include "mjarm/rl/json_internal.hpp"
#include "mjarm/rl/sb3_layers_internal.hpp"

namespace mjarm::rl {
namespace {

constexpr const char* kLogStd = "log_std";
constexpr std::string_view kExtractor = "mlp_extractor.";

/// Collects the layers of one policy.
class Sb3Layers {
 public:
  Sb3Layers(const std::map<std::string, Tensor>& state, const std::string& source)
      : state_(state), source_(source) {}

  Result<TensorSet> policy();

 private:
  tl::unexpected<Error> bad(Msg message, const std::string& name) const {
    return fail(Errc::bad_input, text(message, source_, in_quotes(name)));
  }
  /// Layers of the net "mlp_extractor.NAME" in order: 0, 2, 4, ..., activations between them.
  std::vector<std::string> layers_of(const std::string& net) const;
  Result<void> add_net(const std::string& hidden, const std::string& last, const std::string& name);
  Result<const Tensor*> take(const std::string& name);
  Result<void> add_log_std();

  const std::map<std::string, Tensor>& state_;
  const std::string& source_;
  std::set<std::string> used_;
  TensorSet set_;
};

std::vector<std::string> Sb3Layers::layers_of(const std::string& net) const {
  std::vector<std::string> layers;
  for (;;) {
    const std::string name =
        std::string(kExtractor) + net + "." + std::to_string(2 * layers.size());
    if (!state_.contains(name + ".weight")) return layers;
    layers.push_back(name);
  }
}

Result<const Tensor*> Sb3Layers::take(const std::string& name) {
  const auto found = state_.find(name);
  if (found == state_.end()) return bad(msg::policy_file_sb3_missing, name);
  const auto& values = std::get<std::vector<float>>(found->second.values);
  if (!std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); })) {
    return bad(msg::policy_file_sb3_finite, name);
  }
  used_.insert(name);
  return &found->second;
}

Result<void> Sb3Layers::add_net(const std::string& hidden, const std::string& last,
                                const std::string& name) {
  std::vector<std::string> layers = layers_of("shared_net");
  for (std::string& layer : layers_of(hidden)) layers.push_back(std::move(layer));
  layers.push_back(last);
  std::int64_t inputs = 0;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const Result<const Tensor*> weight = take(layers[i] + ".weight");
    if (!weight) return fail(weight.error());
    const auto& shape = (*weight)->shape;
    if (shape.size() != 2 || shape[0] == 0 || shape[1] == 0 || (i > 0 && shape[1] != inputs)) {
      return bad(msg::policy_file_sb3_shape, layers[i] + ".weight");
    }
    inputs = shape[0];
    const Result<const Tensor*> bias = take(layers[i] + ".bias");
    if (!bias) return fail(bias.error());
    if ((*bias)->shape != std::vector{inputs}) {
      return bad(msg::policy_file_sb3_shape, layers[i] + ".bias");
    }
    const std::string ours = name + "." + std::to_string(i);
    set_.tensors[ours + ".weight"] = **weight;
    set_.tensors[ours + ".bias"] = **bias;
  }
  return {};
}

Result<void> Sb3Layers::add_log_std() {
  const Result<const Tensor*> found = take(kLogStd);
  if (!found) return fail(found.error());
  if ((*found)->shape.size() == 2) {
    return fail(Errc::bad_input, text(msg::policy_file_sb3_sde, source_));
  }
  if ((*found)->shape != state_.at("action_net.bias").shape) {
    return bad(msg::policy_file_sb3_shape, kLogStd);
  }
  set_.tensors[kLogStd] = **found;
  return {};
}

Result<TensorSet> Sb3Layers::policy() {
  auto done = add_net("policy_net", "action_net", "actor");
  if (done) done = add_net("value_net", "value_net", "critic");
  if (done) done = add_log_std();
  if (!done) return fail(std::move(done.error()));
  const std::int64_t observations = set_.tensors.at("actor.0.weight").shape[1];
  if (set_.tensors.at("critic.0.weight").shape[1] != observations ||
      state_.at("value_net.bias").shape != std::vector<std::int64_t>{1}) {
    return bad(msg::policy_file_sb3_shape, "value_net.weight");
  }
  for (const auto& [name, tensor] : state_) {
    if (!used_.contains(name)) return bad(msg::policy_file_sb3_tensor, name);
  }
  const auto vector = [&](double value) {
    return Tensor{{observations}, std::vector(static_cast<std::size_t>(observations), value)};
  };
  set_.tensors["normaliser.mean"] = vector(0);
  set_.tensors["normaliser.variance"] = vector(1);
  set_.tensors["normaliser.count"] = {{}, std::vector{0.0}};
  set_.tensors["normaliser.clip"] = {{}, std::vector{10.0}};
  return std::move(set_);
}

}  // namespace

Result<TensorSet> policy_of_sb3(const std::map<std::string, Tensor>& state,
                                const std::string& source) {
  return Sb3Layers(state, source).policy();
}

}  // namespace mjarm::rl
