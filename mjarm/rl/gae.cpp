#include "mjarm/rl/gae.hpp"

#include <cassert>
#include <vector>

namespace mjarm::rl {

void estimate_advantages(const Experience& experience, double discount, double lambda,
                         std::span<float> advantages, std::span<float> returns) {
  const auto copies = static_cast<std::size_t>(experience.copies);
  const std::size_t size = experience.rewards.size();
  assert(copies > 0 && size % copies == 0 && advantages.size() == size && returns.size() == size);
  std::vector<double> following(copies, 0.0);  // advantage of the step after
  for (std::size_t i = size; i-- > 0;) {
    const std::size_t copy = i % copies;
    const bool is_last = i + copies >= size;
    const bool terminated = experience.terminated[i] != 0;
    const bool truncated = experience.truncated[i] != 0;
    double next = is_last ? experience.last_values[copy] : experience.values[i + copies];
    if (truncated) next = experience.final_values[i];
    if (terminated) next = 0;
    if (terminated || truncated) following[copy] = 0;
    const double value = experience.values[i];
    const double error = static_cast<double>(experience.rewards[i]) + discount * next - value;
    following[copy] = error + discount * lambda * following[copy];
    advantages[i] = static_cast<float>(following[copy]);
    returns[i] = static_cast<float>(following[copy] + value);
  }
}

}  // namespace mjarm::rl
