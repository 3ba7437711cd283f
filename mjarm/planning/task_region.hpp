#pragma once

#include <Eigen/Core>
#include <limits>
#include <numbers>
#include <optional>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm {

/// What R may hang on: a door that turns about its hinge, a drawer that shifts along its slide. It
/// may stand anywhere in its range. As it is made, a hinge about z of the world that stands still.
struct Mechanism {
  JointType type = JointType::hinge;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();      ///< [m] a point of a hinge's axis
  Eigen::Vector3d axis_W = Eigen::Vector3d::UnitZ();  ///< length 1
  /// [rad] within +-2 pi, no more than a turn from least to largest, which is free; or [m] within
  /// +-kWidestPlace.
  double min = 0;
  double max = 0;  ///< [rad] or [m] >= min
};

/// A set of poses of the tool T, as the task space regions of D. Berenson, S. Srinivasa and
/// J. Kuffner, IJRR 30 (2011) 1435: a frame F, in which the tool stands still, moves within bounds
/// along and about the axes of a frame R, which stands still in the world or hangs on a mechanism.
/// Where a path may begin, where it may end, and where the tool stays on its way. As it is made,
/// one pose: X_WR.
///
/// A grasp of a can from any side: R is the frame of the can, X_FT the tool as it grasps the can
/// in one way, and the yaw is free.
struct TaskRegion {
  Pose X_WR = {};  ///< of the bounds in the world; with a mechanism, where that stands at 0
  Pose X_FT = {};  ///< of the tool in the frame that is bounded
  Eigen::Vector3d place_min = Eigen::Vector3d::Zero();  ///< [m] p_RF, within +-kWidestPlace or -inf
  Eigen::Vector3d place_max = Eigen::Vector3d::Zero();  ///< [m] likewise, or inf; >= place_min
  /// [rad] roll, pitch and yaw of F in R, R_RF = Rz(yaw) Ry(pitch) Rx(roll) (from_euler()): roll
  /// and yaw within +-2 pi, no more than a turn from least to largest, which is free; pitch within
  /// +-pi/2.
  Eigen::Vector3d turn_min = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn_max = Eigen::Vector3d::Zero();  ///< [rad] >= turn_min
  double lean = std::numbers::pi;  ///< [rad] 0 to pi, which is free: between z of F and z of R
  /// R moves with it: a chain of two regions, of which the first has one turn or shift. A pose is
  /// in the region where it is for some value of the mechanism.
  std::optional<Mechanism> mechanism = {};
};

/// [m] bounds of a place that are farther out are to be infinite.
inline constexpr double kWidestPlace = 10;
/// What is free.
inline constexpr double kFreePlace = std::numeric_limits<double>::infinity();  ///< [m]
inline constexpr double kFreeTurn = std::numbers::pi;       ///< [rad] to both sides, roll or yaw
inline constexpr double kFreePitch = std::numbers::pi / 2;  ///< [rad] to both sides

/// A region round a pose of the tool.
/// @param half  [m] to both sides along each axis of the pose.
/// @param lean  [rad] of the tool's z axis, 0 to pi.
/// @param turn  [rad] about the z axis of the pose, to both sides, 0 to pi.
[[nodiscard]] TaskRegion region_about(const Pose& X_WT,
                                      const Eigen::Vector3d& half = Eigen::Vector3d::Zero(),
                                      double lean = 0, double turn = 0);

/// Whether its numbers are in their ranges, and there is a pose in it.
[[nodiscard]] bool is_sound(const TaskRegion& region) noexcept;
/// Whether its numbers are in their ranges.
[[nodiscard]] bool is_sound(const Mechanism& mechanism) noexcept;

/// The region as it is while its mechanism stands at a value [rad] or [m]: one without any.
[[nodiscard]] TaskRegion standing_at(const TaskRegion& region, double value) noexcept;

/// [rad] or [m] where the mechanism stands when the tool is at `X_WT`: in the middle of the values
/// for which the pose is within the bounds, or at the end of the range that is next to it. So the
/// pose is within the region, to 1e-7 m and rad, if it is for any value. Of a pose outside:
/// likewise for wider bounds. 0: there is no mechanism.
[[nodiscard]] double value_for(const TaskRegion& region, const Pose& X_WT) noexcept;

/// [m], [rad] what is bounded has to leave at least so much from one end to the other for a path to
/// be kept within: edges in joint space are no straight lines of the tool.
inline constexpr double kLeastPlaceRange = 1e-3, kLeastTurnRange = 2e-3;
/// Whether a path can be kept within: it is sound and nowhere narrower than that (a lean of half as
/// much will do).
[[nodiscard]] bool can_be_kept(const TaskRegion& region) noexcept;

/// What roll (axis 0), pitch (1) or yaw (2) are held to.
struct TurnBounds {
  double min;  ///< [rad] -inf: to nothing
  double max;  ///< [rad] inf: to nothing

  [[nodiscard]] bool any() const noexcept { return min > -kFreePlace || max < kFreePlace; }
};
[[nodiscard]] TurnBounds turn_bounds(const TaskRegion& region, int axis) noexcept;

/// [rad] roll or yaw in the winding that is nearest to the middle of its bounds, which are finite.
[[nodiscard]] double nearest_winding_to(double angle, const TurnBounds& bounds) noexcept;

/// How far inside of its nearest bounds a pose is, the mechanism at value_for(); below 0: outside,
/// by so much.
struct RegionRoom {
  double place = kFreePlace;                              ///< [m] inf: all places are free
  double turn = std::numeric_limits<double>::infinity();  ///< [rad] inf: all turns are free

  [[nodiscard]] bool within(double slack = 0) const { return place >= -slack && turn >= -slack; }
};
[[nodiscard]] RegionRoom room_in(const TaskRegion& region, const Pose& X_WT) noexcept;

/// A pose of the tool in the region near to `X_WT`: place, roll, pitch and yaw within their bounds,
/// then roll and pitch brought back until the lean is; the mechanism at value_for().
[[nodiscard]] Pose nearest_in(const TaskRegion& region, const Pose& X_WT);

/// The tool in the middle of the region; what is free is as in R, or as near to it as may be.
[[nodiscard]] Pose middle_of(const TaskRegion& region);

/// A pose of the tool drawn from the region: places even in the box, directions of R's z axis, as F
/// sees it, even on what roll, pitch and lean leave of the sphere, the yaw and the mechanism even.
/// @param base    [m] where places are free they are drawn round this place in the world,
/// @param radius  [m] within so much.
[[nodiscard]] Pose draw_from(const TaskRegion& region, const Eigen::Vector3d& base, double radius,
                             Rng& rng);

}  // namespace mjarm
