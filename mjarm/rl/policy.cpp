#include "mjarm/rl/policy.hpp"

#include <cassert>
#include <utility>

namespace mjarm::rl {
namespace {

using Weights = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

void add_block(std::vector<ParameterBlock>& blocks, std::string name, int rows, int cols) {
  std::size_t offset = 0;
  if (!blocks.empty()) {
    const ParameterBlock& last = blocks.back();
    offset =
        last.offset + static_cast<std::size_t>(last.rows) * static_cast<std::size_t>(last.cols);
  }
  blocks.push_back({std::move(name), rows, cols, offset});
}

void add_layers(std::vector<ParameterBlock>& blocks, const std::string& net, int inputs,
                const std::vector<int>& hidden, int outputs) {
  for (std::size_t i = 0; i <= hidden.size(); ++i) {
    const int rows = i < hidden.size() ? hidden[i] : outputs;
    const std::string layer = net + "." + std::to_string(i);
    add_block(blocks, layer + ".weight", rows, inputs);
    add_block(blocks, layer + ".bias", rows, 1);
    inputs = rows;
  }
}

/// The output of the layers from block `first` on, `layers` of them.
Eigen::VectorXf run_layers(const Policy& policy, std::size_t first, std::size_t layers,
                           std::span<const float> observation) {
  assert(static_cast<int>(observation.size()) == policy.shape().observations);
  Eigen::VectorXf x(observation.size());
  policy.normaliser.apply(observation, {x.data(), observation.size()});
  for (std::size_t i = 0; i < layers; ++i) {
    const ParameterBlock& weight = policy.blocks()[first + 2 * i];
    const ParameterBlock& bias = policy.blocks()[first + 2 * i + 1];
    const float* parameters = policy.parameters().data();
    const Eigen::Map<const Weights> W(parameters + weight.offset, weight.rows, weight.cols);
    const Eigen::Map<const Eigen::VectorXf> b(parameters + bias.offset, bias.rows);
    const Eigen::VectorXf y = W * x + b;
    if (i + 1 == layers) return y;
    x = policy.shape().activation == Activation::tanh ? Eigen::VectorXf(y.array().tanh())
                                                      : Eigen::VectorXf(y.cwiseMax(0.0F));
  }
  return x;
}

}  // namespace

std::string_view name(Activation activation) noexcept {
  return activation == Activation::tanh ? "tanh" : "relu";
}

Policy::Policy(PolicyShape shape) : shape_(std::move(shape)) {
  add_layers(blocks_, "actor", shape_.observations, shape_.actor, shape_.actions);
  add_layers(blocks_, "critic", shape_.observations, shape_.critic, 1);
  add_block(blocks_, "log_std", shape_.actions, 1);
  parameters_.resize(blocks_.back().offset + static_cast<std::size_t>(shape_.actions));
  normaliser.mean = Eigen::VectorXd::Zero(shape_.observations);
  normaliser.variance = Eigen::VectorXd::Ones(shape_.observations);
}

std::span<const float> Policy::log_std() const noexcept {
  return parameters().subspan(blocks_.back().offset);
}

Eigen::VectorXf Policy::act(std::span<const float> observation) const {
  return run_layers(*this, 0, shape_.actor.size() + 1, observation);
}

float Policy::value(std::span<const float> observation) const {
  return run_layers(*this, 2 * (shape_.actor.size() + 1), shape_.critic.size() + 1, observation)[0];
}

}  // namespace mjarm::rl
