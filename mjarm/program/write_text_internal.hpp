#pragma once

#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/program/program.hpp"

namespace mjarm::program::detail {

/// The way of a pen that writes a text.
struct WrittenText {
  Curve curve;
  std::vector<Pose> corners;  ///< of a way of straight lines alone, both ends included; else none
};

/// One curve for each stroke of `text`, the pen lifted all the time: as it moves to be pressed.
[[nodiscard]] Result<std::vector<Curve>> lifted_strokes(const DrawText& text, const Pose& X_WP,
                                                        const Eigen::Matrix3d& R_WT);

/// The strokes of `text`, the pen lifted before and after each.
/// @param X_WP  the plane of the text in the world.
/// @param R_WT  of the tool.
/// @return what is wrong with the text, as of letter_strokes().
[[nodiscard]] Result<WrittenText> write_text(const DrawText& text, const Pose& X_WP,
                                             const Eigen::Matrix3d& R_WT);

}  // namespace mjarm::program::detail
