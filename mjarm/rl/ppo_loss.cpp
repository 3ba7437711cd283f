#include <algorithm>
#include <cmath>
#include <numbers>

#include "mjarm/rl/ppo_loss_internal.hpp"

namespace mjarm::rl::detail {

SurrogateTerm surrogate_term(double log_ratio, double advantage, double clip) {
  const double ratio = std::exp(log_ratio);
  const double free = ratio * advantage;
  const double bound = std::clamp(ratio, 1 - clip, 1 + clip) * advantage;
  const bool clipped = std::abs(ratio - 1) > clip;
  const double kl = (ratio - 1) - log_ratio;
  // Where the bound is less than the free value, the ratio is clamped: it has no slope.
  if (bound < free) return {-bound, 0, kl, clipped};
  return {-free, -free, kl, clipped};
}

ValueTerm value_term(double value, double old_value, double target, double clip) {
  const double change = value - old_value;
  if (clip > 0 && std::abs(change) > clip) {
    const double error = old_value + std::copysign(clip, change) - target;
    return {error * error, 0};
  }
  const double error = value - target;
  return {error * error, 2 * error};
}

Gaussian::Gaussian(std::span<const float> log_std) {
  const double half_log_two_pi = std::log(2 * std::numbers::pi) / 2;
  for (const float log_deviation : log_std) {
    deviation_.push_back(std::exp(static_cast<double>(log_deviation)));
    inverse_.push_back(1 / deviation_.back());
    constant_ -= static_cast<double>(log_deviation) + half_log_two_pi;
    entropy_ += static_cast<double>(log_deviation) + half_log_two_pi + 0.5;
  }
}

double Gaussian::log_prob(const float* action, const float* mean) const noexcept {
  double squares = 0;
  for (std::size_t i = 0; i < inverse_.size(); ++i) {
    const double z = distance(i, action, mean);
    squares += z * z;
  }
  return constant_ - squares / 2;
}

}  // namespace mjarm::rl::detail
