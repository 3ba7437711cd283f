#pragma once

#include <Eigen/Core>
#include <numbers>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"

namespace mjarm {

/// One stroke of a pen, which is lifted before and after it.
struct Stroke {
  /// At least two, in the plane's own x (to the right) and y (up) [m].
  std::vector<Eigen::Vector2d> points;
  /// A smooth curve through the points, which keeps its corners (kStrokeCorner); else straight from
  /// point to point.
  bool smooth = false;
};

/// [rad] Where a smooth stroke turns by more from chord to chord it has a corner.
inline constexpr double kStrokeCorner = std::numbers::pi / 3;

/// The strokes of `text` in the order of writing, on one line from (0, 0) to the right: A-Z (small
/// letters are written as capitals), 0-9 and space, straight; Chinese characters, smooth, where
/// `mjarm models install hanzi` has fetched their strokes (npm's hanzi-writer-data).
/// @param height  [m] of every letter, and of the square that a Chinese character stands in, > 0
/// @return an error that names the first character without strokes; not_available where those of
///         Chinese characters were not fetched.
[[nodiscard]] Result<std::vector<Stroke>> letter_strokes(std::string_view text, double height);

}  // namespace mjarm
