#pragma once

#include <cstdlib>

#include "tests/support/sanitized.hpp"

namespace mjarm::testing {

/// How many cases a test runs: `usual`, or `many` where MJARM_LONG_TESTS is set (`./dev long`).
inline int rounds(int usual, int many) {
  return std::getenv("MJARM_LONG_TESTS") != nullptr ? many : usual;
}

/// The same, with fewer for the sanitizers where `usual` would take them minutes: they look at how
/// the code runs, not at how often it is right.
inline int rounds(int usual, int many, int sanitized) {
  return rounds(support::kSanitized ? sanitized : usual, many);
}

}  // namespace mjarm::testing
