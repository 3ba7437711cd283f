#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "mjarm/core/rng.hpp"

namespace mjarm {

/// All orders are alike probable (R. Durstenfeld, CACM 7 (1964) 420).
template <class T>
void shuffle(std::vector<T>& values, Rng& rng) {
  for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[rng.below(i)]);
}

}  // namespace mjarm
