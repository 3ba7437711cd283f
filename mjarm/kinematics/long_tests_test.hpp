#pragma once

#include <algorithm>
#include <cstdlib>

#include "tests/support/sanitized.hpp"

namespace mjarm::testing {

/// How many cases a test runs: `usual`, or `many` where MJARM_LONG_TESTS is set (`./dev long`). The
/// sanitizers look at how the code runs, not at how often it is right, and take ten times as long:
/// they get a tenth, ten at least.
inline int rounds(int usual, int many) {
  if (std::getenv("MJARM_LONG_TESTS") != nullptr) return many;
  const bool tenth = support::kSanitized && usual < many;
  return tenth ? std::max(std::min(usual, 10), usual / 10) : usual;
}

}  // namespace mjarm::testing
