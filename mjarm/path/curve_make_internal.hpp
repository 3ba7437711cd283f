#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
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

/// The bend of a corner between the unit directions `t0` and `t1`, from `radius` before the corner
/// to `radius` behind it: corner + t0 f(u) + t1 g(u), f = -radius (1 - u)^3 (1 + u), g(u) = -f(1 -
/// u), seen from its first point. At either end it has the direction of the leg and no curvature,
/// as the quartic Bezier curve with control points at the corner and at 1 and 1/2 radius on both
/// legs. None where the corner turns back by over 179 degrees.
[[nodiscard]] std::optional<CurvePolynomial> corner_bend(const Eigen::Vector3d& t0,
                                                         const Eigen::Vector3d& t1, double radius);

}  // namespace mjarm::detail
