#include <algorithm>
#include <cmath>

#include "mjarm/rl/adam_internal.hpp"

namespace mjarm::rl::detail {

void Adam::step(const NetKernels& kernels, Workers& workers, std::span<const float> gradient,
                double scale, double rate, double epsilon, std::span<float> parameters) {
  constexpr double kBeta1 = 0.9, kBeta2 = 0.999;
  constexpr std::size_t kPiece = 16384;  // parameters a task
  steps += 1;
  const auto t = static_cast<double>(steps);
  const NetKernels::AdamStep step = {
      static_cast<float>(scale),
      static_cast<float>(kBeta1),
      static_cast<float>(kBeta2),
      static_cast<float>(rate / (1 - std::pow(kBeta1, t))),
      static_cast<float>(1 / std::sqrt(1 - std::pow(kBeta2, t))),
      static_cast<float>(epsilon),
  };
  const std::size_t size = parameters.size();
  workers.run(static_cast<int>((size + kPiece - 1) / kPiece), [&](int task, int) {
    const std::size_t at = static_cast<std::size_t>(task) * kPiece;
    kernels.adam(step, static_cast<long>(std::min(kPiece, size - at)), gradient.data() + at,
                 first.data() + at, second.data() + at, parameters.data() + at);
  });
}

}  // namespace mjarm::rl::detail
