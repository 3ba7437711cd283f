#pragma once

#include <limits>
#include <numbers>

/// Numbers that many tests name.
namespace mjarm::support {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kInf = std::numeric_limits<double>::infinity();
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace mjarm::support
