#pragma once

/// Shape of the draggable target, in lengths of its arrows.
namespace mjarm::gizmo {

inline constexpr double kArrowBegin = 0.22;
inline constexpr double kRing = 0.72;        ///< radius
inline constexpr double kSquare = 0.38;      ///< from the middle to the middle of a square
inline constexpr double kSquareHalf = 0.10;  ///< half of its side
inline constexpr double kBall = 0.10;        ///< radius
inline constexpr int kRingPieces = 64;
inline constexpr double kEdgeOn = 0.14;  ///< sine of the angle below which a square is not seen

}  // namespace mjarm::gizmo
