#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace mjarm {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// False where one is infinite or no number.
[[nodiscard]] inline bool all_finite(std::span<const double> values) noexcept {
  return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace mjarm
