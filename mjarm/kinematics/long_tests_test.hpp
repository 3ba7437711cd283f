#pragma once

#include <cstdlib>

namespace mjarm::testing {

/// How many cases a test runs: `usual`, or `many` where MJARM_LONG_TESTS is set (`./dev long`).
inline int rounds(int usual, int many) {
  return std::getenv("MJARM_LONG_TESTS") != nullptr ? many : usual;
}

}  // namespace mjarm::testing
