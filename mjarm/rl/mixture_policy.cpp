#include "mjarm/rl/mixture_policy.hpp"

#include <cassert>
#include <string>
#include <utility>

#include "mjarm/core/messages/rl.hpp"

namespace mjarm::rl {
namespace {

constexpr const char* kModes = "modes";

}  // namespace

MixturePolicy::MixturePolicy(Policy policy, int modes) : net(std::move(policy)), modes_(modes) {
  assert(modes > 0 && net.shape().actions % modes == 0 && actions() > 0);
}

Eigen::VectorXf MixturePolicy::act(std::span<const float> observation) const {
  const Eigen::VectorXf out = net.act(observation);
  Eigen::Index best = 0;
  out.tail(modes_).maxCoeff(&best);
  return out.segment(best * actions(), actions());
}

TensorSet MixturePolicy::tensors() const {
  TensorSet out = net.tensors();
  out.metadata[kModes] = std::to_string(modes_);
  return out;
}

Result<MixturePolicy> MixturePolicy::from(const TensorSet& set) {
  Result<Policy> net = Policy::from(set);
  if (!net) return fail(std::move(net.error()));
  const auto found = set.metadata.find(kModes);
  const std::string word = found == set.metadata.end() ? "" : found->second;
  const int outputs = net->shape().actions;
  for (int modes = 1; 2 * modes <= outputs; ++modes) {
    if (word == std::to_string(modes) && outputs % modes == 0) {
      return MixturePolicy(std::move(*net), modes);
    }
  }
  return fail(Errc::bad_input,
              text(msg::rl_metadata, kModes, word, text(msg::rl_modes_expected, outputs)));
}

}  // namespace mjarm::rl
