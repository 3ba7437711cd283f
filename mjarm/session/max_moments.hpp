#pragma once

#include <algorithm>
#include <cstddef>

#include "mjarm/sim/sim.hpp"

namespace mjarm::session {

/// How many moments of a simulation are kept to be looked back at: as many as 64 MiB hold, 10 at
/// least and `limit` at most.
[[nodiscard]] inline std::size_t max_moments(const Sim& sim, std::size_t limit) {
  constexpr std::size_t kMaxNumbers = std::size_t{8} << 20;  // of all moments together
  const std::size_t numbers = std::max<std::size_t>(sim.snapshot().state.size(), 1);
  return std::clamp(kMaxNumbers / numbers, std::size_t{10}, limit);
}

}  // namespace mjarm::session
