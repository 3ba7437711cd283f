#include <algorithm>
#include <cmath>
#include <numbers>

#include "mjarm/rl/mixture_loss_internal.hpp"

namespace mjarm::rl::detail {
namespace {

double log_of_sum(std::span<const double> logs) {
  const double top = *std::ranges::max_element(logs);
  double sum = 0;
  for (const double value : logs) sum += std::exp(value - top);
  return top + std::log(sum);
}

}  // namespace

MixtureLoss::MixtureLoss(int actions, int modes)
    : actions_(actions),
      modes_(modes),
      log_share_(static_cast<std::size_t>(modes)),
      log_joint_(static_cast<std::size_t>(modes)) {}

double MixtureLoss::operator()(std::span<const float> out, std::span<const float> log_std,
                               std::span<const float> action, std::span<double> by_out,
                               std::span<double> by_log_std) {
  const double half_log_2pi = 0.5 * std::log(2 * std::numbers::pi);
  const std::span<const float> logits = out.last(static_cast<std::size_t>(modes_));
  std::ranges::copy(logits, log_share_.begin());
  const double all = log_of_sum(log_share_);
  const auto distance = [&](int i, int d) {
    return (double(action[d]) - double(out[i])) * std::exp(-double(log_std[i]));
  };
  for (int k = 0; k < modes_; ++k) {
    log_share_[k] -= all;
    log_joint_[k] = log_share_[k];
    for (int d = 0; d < actions_; ++d) {
      const int i = k * actions_ + d;
      const double z = distance(i, d);
      log_joint_[k] -= 0.5 * z * z + double(log_std[i]) + half_log_2pi;
    }
  }
  const double log_likelihood = log_of_sum(log_joint_);
  for (int k = 0; k < modes_; ++k) {
    const double share = std::exp(log_joint_[k] - log_likelihood);  // that this mode answers for
    by_out[modes_ * actions_ + k] = std::exp(log_share_[k]) - share;
    for (int d = 0; d < actions_; ++d) {
      const int i = k * actions_ + d;
      const double z = distance(i, d);
      by_out[i] = -share * z * std::exp(-double(log_std[i]));
      by_log_std[i] += share * (1 - z * z);
    }
  }
  return -log_likelihood;
}

}  // namespace mjarm::rl::detail
