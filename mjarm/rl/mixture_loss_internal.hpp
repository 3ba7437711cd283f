#pragma once

#include <span>
#include <vector>

namespace mjarm::rl::detail {

/// -ln of the likelihood of one action under a mixture, and its slopes.
class MixtureLoss {
 public:
  MixtureLoss(int actions, int modes);

  /// @param out      (modes * actions + modes,) centres and logits
  /// @param log_std  (modes * actions, ...) of the centres
  /// @param action   (actions,)
  /// @param by_out   gets the slopes by `out`
  /// @param by_log_std  the slopes by log_std are added there
  double operator()(std::span<const float> out, std::span<const float> log_std,
                    std::span<const float> action, std::span<double> by_out,
                    std::span<double> by_log_std);

 private:
  int actions_, modes_;
  std::vector<double> log_share_, log_joint_;  ///< (modes,)
};

}  // namespace mjarm::rl::detail
