#pragma once

#include <Eigen/Core>
#include <span>

#include "mjarm/core/result.hpp"
#include "mjarm/rl/policy.hpp"
#include "mjarm/rl/tensor_set.hpp"

namespace mjarm::rl {

/// A policy that knows several ways where demonstrations differ: a mixture of Gaussians, centres
/// and weights from a net, deviations as numbers of their own (C. M. Bishop, Mixture Density
/// Networks, Aston University NCRG/94/004, 1994). The mean of two ways is often none.
class MixturePolicy {
 public:
  /// @param net    its outputs are the centres of the modes, one after another, and then their
  ///               weights as logits; `log_std` is of the centres. Its critic is not used.
  /// @param modes  that divide its outputs without rest.
  MixturePolicy(Policy net, int modes);

  [[nodiscard]] int modes() const noexcept { return modes_; }
  [[nodiscard]] int actions() const noexcept { return net.shape().actions / modes_ - 1; }
  /// Outputs of the net of a policy of such a size.
  [[nodiscard]] static int outputs(int actions, int modes) noexcept {
    return modes * (actions + 1);
  }

  /// The centre of the mode with the greatest weight.
  /// @param observation (observations,), not normalised.  @return (actions,)
  [[nodiscard]] Eigen::VectorXf act(std::span<const float> observation) const;

  /// As Policy::tensors(), with the modes in the metadata.
  [[nodiscard]] TensorSet tensors() const;
  /// @return as Policy::from(); bad_input where the modes are missing or do not fit.
  [[nodiscard]] static Result<MixturePolicy> from(const TensorSet& set);

  Policy net;

 private:
  int modes_;
};

}  // namespace mjarm::rl
