#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"

namespace mjarm {

/// Corner points of one stroke in the plane's own x (to the right) and y (up) [m].
using Stroke = std::vector<Eigen::Vector2d>;

/// The straight strokes of `text` in the order of writing, at least two points each: A-Z (small
/// letters are written as capitals), 0-9 and space, on one line from (0, 0) to the right.
/// @param height  [m] of every letter, > 0
/// @return an error that names the first character without strokes.
[[nodiscard]] Result<std::vector<Stroke>> letter_strokes(std::string_view text, double height);

}  // namespace mjarm
