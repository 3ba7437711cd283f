#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "mjarm/rl/ppo_gradient_internal.hpp"

namespace mjarm::testing {

using namespace rl;

/// PPO's loss in double precision, written down from its definition, number by number: the oracle
/// of the gradient.
class ReferenceLoss {
 public:
  ReferenceLoss(const Policy& policy, const rl::detail::Samples& samples,
                std::span<const int> which, const PpoOptions& options)
      : policy_(policy), samples_(samples), which_(which), options_(options) {}

  /// policy + value_weight value - entropy_weight entropy, for these parameters.
  [[nodiscard]] double total(const std::vector<double>& parameters) const {
    const auto actions = static_cast<std::size_t>(policy_.shape().actions);
    const double* log_std = parameters.data() + parameters.size() - actions;
    double mean = 0, squares = 0;
    for (const int i : which_) mean += samples_.advantages[i] / n();
    for (const int i : which_) squares += std::pow(samples_.advantages[i] - mean, 2);
    const double deviation = std::sqrt(squares / (n() - 1)) + 1e-8;
    double policy_loss = 0, value_loss = 0, entropy = 0;
    for (const int i : which_) {
      const std::vector<double> means = outputs(true, parameters, i);
      double log_prob = 0;
      for (std::size_t k = 0; k < actions; ++k) {
        const double z = (samples_.actions[i * actions + k] - means[k]) / std::exp(log_std[k]);
        log_prob += -z * z / 2 - log_std[k] - std::log(2 * std::numbers::pi) / 2;
      }
      double advantage = samples_.advantages[i];
      if (options_.normalise_advantages) advantage = (advantage - mean) / deviation;
      const double ratio = std::exp(log_prob - samples_.log_probs[i]);
      const double cut = std::min(std::max(ratio, 1 - options_.clip), 1 + options_.clip);
      policy_loss -= std::min(ratio * advantage, cut * advantage) / n();
      double value = outputs(false, parameters, i)[0];
      const double old = samples_.values[i];
      if (options_.value_clip > 0) {
        value = std::min(std::max(value, old - options_.value_clip), old + options_.value_clip);
      }
      value_loss += std::pow(value - samples_.returns[i], 2) / n();
    }
    for (std::size_t k = 0; k < actions; ++k) {
      entropy += log_std[k] + 0.5 * std::log(2 * std::numbers::pi * std::numbers::e);
    }
    return policy_loss + options_.value_weight * value_loss - options_.entropy_weight * entropy;
  }

  /// By central differences.
  [[nodiscard]] std::vector<double> gradient() const {
    constexpr double kStep = 1e-6;
    std::vector<double> at(policy_.parameters().begin(), policy_.parameters().end());
    std::vector<double> out;
    for (double& parameter : at) {
      const double middle = parameter;
      parameter = middle + kStep;
      const double above = total(at);
      parameter = middle - kStep;
      out.push_back((above - total(at)) / (2 * kStep));
      parameter = middle;
    }
    return out;
  }

 private:
  [[nodiscard]] double n() const { return static_cast<double>(which_.size()); }

  [[nodiscard]] std::vector<double> outputs(bool actor, const std::vector<double>& parameters,
                                            int sample) const {
    const auto size = static_cast<std::size_t>(policy_.shape().observations);
    const auto row = samples_.observations.subspan(sample * size, size);
    std::vector<double> x(row.begin(), row.end());
    const std::string net = actor ? "actor." : "critic.";
    const std::size_t hidden = (actor ? policy_.shape().actor : policy_.shape().critic).size();
    for (std::size_t layer = 0; layer <= hidden; ++layer) {
      const double* W = parameters.data() + offset(net + std::to_string(layer) + ".weight");
      const double* b = parameters.data() + offset(net + std::to_string(layer) + ".bias");
      const std::size_t rows = static_cast<std::size_t>(b - W) / x.size();
      std::vector<double> y(b, b + rows);
      for (std::size_t i = 0; i < rows; ++i) {
        for (std::size_t k = 0; k < x.size(); ++k) y[i] += W[i * x.size() + k] * x[k];
        if (layer == hidden) continue;
        const bool tanh = policy_.shape().activation == Activation::tanh;
        y[i] = tanh ? std::tanh(y[i]) : std::max(y[i], 0.0);
      }
      x = y;
    }
    return x;
  }

  [[nodiscard]] std::size_t offset(const std::string& name) const {
    return std::ranges::find(policy_.blocks(), name, &ParameterBlock::name)->offset;
  }

  const Policy& policy_;
  const rl::detail::Samples& samples_;
  std::span<const int> which_;
  const PpoOptions& options_;
};

}  // namespace mjarm::testing
