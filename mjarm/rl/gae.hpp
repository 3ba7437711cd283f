#pragma once

#include <cstdint>
#include <span>

namespace mjarm::rl {

/// A piece of experience of many copies: step by step, and of each step copy by copy, so that the
/// number of copy `c` in step `t` stands at [t * copies + c].
struct Experience {
  int copies = 0;
  std::span<const float> rewards;
  std::span<const float> values;             ///< of the observations that were acted upon
  std::span<const std::uint8_t> terminated;  ///< 1: no reward can follow
  std::span<const std::uint8_t> truncated;   ///< 1: cut, but rewards would have followed
  std::span<const float> final_values;  ///< of the last observation of an episode, where truncated
  std::span<const float> last_values;   ///< (copies,) of what was observed after the last step
};

/// Generalised advantage estimation (J. Schulman et al., arXiv:1506.02438): the sum of the one-step
/// errors r + discount V' - V that follow in the same episode, each weighted by
/// (discount lambda)^steps. V' is 0 after a termination and the value of the final observation at a
/// truncation; beyond either nothing is summed.
/// @param advantages  one for each reward.
/// @param returns     advantages + values, what the critic is to learn; as many.
void estimate_advantages(const Experience& experience, double discount, double lambda,
                         std::span<float> advantages, std::span<float> returns);

}  // namespace mjarm::rl
