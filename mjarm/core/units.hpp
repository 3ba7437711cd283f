#pragma once

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

/// Reads `90deg`, `25mm`, `0.3`, `1e-3`, `1.57 rad`; the result is in SI units (rad, m, s, m/s).
/// @return one line that names `words` where they are no number, not finite or carry a unit that
///         does not fit.
[[nodiscard]] Result<double> parse_quantity(std::string_view words, Quantity quantity);

/// Entries of a list parted by commas or, where there is none, by blanks; views into `words`.
[[nodiscard]] std::vector<std::string_view> split_list(std::string_view words);

/// Reads a list parted by commas or spaces, each entry as in `parse_quantity`: `0,-90deg, 1.57`.
[[nodiscard]] Result<std::vector<double>> parse_quantities(std::string_view words,
                                                           Quantity quantity);

}  // namespace mjarm
