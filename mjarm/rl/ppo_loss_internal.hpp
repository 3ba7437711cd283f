#pragma once

#include <span>
#include <vector>

/// The terms of PPO's loss for one sample, with their derivatives (J. Schulman et al.,
/// arXiv:1707.06347). All of them are averaged over a minibatch.
namespace mjarm::rl::detail {

/// The clipped surrogate.
struct SurrogateTerm {
  double loss;   ///< -min(ratio advantage, clamp(ratio, 1 - clip, 1 + clip) advantage)
  double slope;  ///< derivative of the loss by the logarithm of the probability
  double kl;     ///< (ratio - 1) - log ratio, >= 0
  bool clipped;  ///< whether the ratio is outside 1 +- clip
};
[[nodiscard]] SurrogateTerm surrogate_term(double log_ratio, double advantage, double clip);

/// The squared error of the critic, whose change is cut to `clip` where that is above 0.
struct ValueTerm {
  double loss;
  double slope;  ///< derivative by the value
};
[[nodiscard]] ValueTerm value_term(double value, double old_value, double target, double clip);

/// Independent normal distributions of one mean each and deviations that no observation changes.
class Gaussian {
 public:
  explicit Gaussian(std::span<const float> log_std);

  [[nodiscard]] double deviation(std::size_t i) const { return deviation_[i]; }
  /// [nat]
  [[nodiscard]] double entropy() const noexcept { return entropy_; }
  /// Logarithm of the density at `action`.  @param action, mean  (actions,)
  [[nodiscard]] double log_prob(const float* action, const float* mean) const noexcept;
  /// (action - mean) / deviation of number `i`.
  [[nodiscard]] double distance(std::size_t i, const float* action,
                                const float* mean) const noexcept {
    return (static_cast<double>(action[i]) - static_cast<double>(mean[i])) * inverse_[i];
  }
  /// 1 / deviation
  [[nodiscard]] double inverse(std::size_t i) const { return inverse_[i]; }

 private:
  std::vector<double> deviation_, inverse_;
  double constant_ = 0;  ///< logarithm of the density at the mean
  double entropy_ = 0;
};

}  // namespace mjarm::rl::detail
