#pragma once

#include <numbers>
#include <span>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"

namespace mjarm {

/// What a number on the command line measures; decides which unit suffixes it may carry.
enum class Quantity {
  number,  ///< no unit
  angle,   ///< rad (default), mrad, deg
  length,  ///< m (default), cm, mm, um
  time,    ///< s (default), ms, us, min
  speed,   ///< m/s (default), cm/s, mm/s
};

inline constexpr double kRadPerDeg = std::numbers::pi / 180;
inline constexpr double kDegPerRad = 180 / std::numbers::pi;
inline constexpr double kFullTurn = 2 * std::numbers::pi;  ///< [rad]

/// What is taken without a unit at most: more was meant in degrees or millimetres.
inline constexpr double kMaxBareAngle = kFullTurn + 0.01;  ///< [rad] a turn, rounded
inline constexpr double kMaxBareLength = 10;               ///< [m]

/// A number as it was written.
struct WrittenNumber {
  double value = 0;                  ///< in SI units; as it stands where it has none
  Quantity unit = Quantity::number;  ///< what its unit measures; `number` where it has none
};

/// Reads a number that may carry a unit of any of `quantities`.
/// @return one line that names `words` where they are no number, not finite or carry another unit.
[[nodiscard]] Result<WrittenNumber> parse_written(std::string_view words,
                                                  std::span<const Quantity> quantities);

/// The line that refuses `words`, read as that many rad or m, for want of a unit.
[[nodiscard]] std::string unit_wanted(std::string_view words, Quantity quantity);

/// Reads `90deg`, `25mm`, `0.3`, `1e-3`, `1.57 rad`; the result is in SI units (rad, m, s, m/s).
/// @return one line that names `words` where they are no number, not finite, carry a unit that
///         does not fit, or are an angle or a length beyond kMaxBareAngle or kMaxBareLength without
///         a unit.
[[nodiscard]] Result<double> parse_quantity(std::string_view words, Quantity quantity);

/// Entries of a list parted by commas or, where there is none, by blanks; views into `words`.
[[nodiscard]] std::vector<std::string_view> split_list(std::string_view words);

/// Reads a list parted by commas or spaces, each entry as in `parse_quantity`: `0,-90deg, 1.57`.
[[nodiscard]] Result<std::vector<double>> parse_quantities(std::string_view words,
                                                           Quantity quantity);

}  // namespace mjarm
