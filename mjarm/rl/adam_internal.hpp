#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mjarm/rl/net_kernels_internal.hpp"
#include "mjarm/rl/workers_internal.hpp"

namespace mjarm::rl::detail {

/// Adam (D. P. Kingma and J. Ba, arXiv:1412.6980) with beta 0.9 and 0.999.
struct Adam {
  std::vector<float> first;   ///< running mean of the gradient
  std::vector<float> second;  ///< of its square
  std::int64_t steps = 0;

  explicit Adam(std::size_t parameters) : first(parameters), second(parameters) {}

  /// One step.
  /// @param scale  by which the gradient is multiplied first.
  void step(const NetKernels& kernels, Workers& workers, std::span<const float> gradient,
            double scale, double rate, double epsilon, std::span<float> parameters);
};

}  // namespace mjarm::rl::detail
