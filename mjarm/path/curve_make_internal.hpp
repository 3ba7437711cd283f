#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/path/curve_piece.hpp"

/// What the makers of curves share.
namespace mjarm::detail {

inline constexpr double kSamePoint = 1e-9;  // [m]
inline constexpr double kSameTurn = 1e-9;   // [rad]
inline constexpr double kFarthest = 1e6;    // [m]

/// The poses with their rotations cleaned of rounding, or what is wrong with them.
[[nodiscard]] Result<std::vector<Pose>> checked_poses(std::span<const Pose> poses);

/// A straight piece or a turn on the spot; none where the poses are the same.
[[nodiscard]] std::optional<CurvePiece> straight_piece(const Pose& from, const Pose& to);

/// True where the tool passes from one piece to the next without a jump in its velocity.
[[nodiscard]] bool smooth_joint(const CurvePiece& before, const CurvePiece& after);

/// A part of a curve without corners of its own: a straight piece, a turn on the spot, or the
/// pieces of an arc of a circle.
using CurveLeg = std::vector<CurvePiece>;

/// Legs one after another, their corners blended; what a curve is made of.
struct JoinedLegs {
  std::vector<CurvePiece> pieces;
  std::vector<CurveBlend> blends;
  std::vector<double> joints;
};

/// See Curve::joined(); `blends` [m], one for each corner, were checked.
[[nodiscard]] JoinedLegs join(std::span<const CurveLeg> legs, std::span<const double> blends);

/// What is wrong with the blends of a curve with so many inner points; none where nothing is.
[[nodiscard]] std::optional<Error> blends_error(std::span<const double> blends,
                                                std::size_t inner_points);

}  // namespace mjarm::detail
