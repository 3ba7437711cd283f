#pragma once

#include <cstdlib>

#include "tests/support/sanitized.hpp"

namespace mjarm::testing {

/// Whether these are the long tests: `./dev long` sets MJARM_LONG_TESTS.
inline bool is_long() { return std::getenv("MJARM_LONG_TESTS") != nullptr; }

/// Why a test that takes too long for every change is skipped.
inline constexpr const char* kLongOnly = "takes long: a test of ./dev long";

/// How many cases a test runs: `usual`, or `many` in the long tests.
inline int rounds(int usual, int many) { return is_long() ? many : usual; }

/// The same, with fewer for the sanitizers where `usual` would take them minutes: they look at how
/// the code runs, not at how often it is right.
inline int rounds(int usual, int many, int sanitized) {
  return rounds(support::kSanitized ? sanitized : usual, many);
}

}  // namespace mjarm::testing
