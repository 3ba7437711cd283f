#pragma once

#include <Eigen/Core>
#include <span>

#include "mjarm/model/arm.hpp"
#include "mjarm/planning/task_region.hpp"

namespace mjarm {

/// How far a tool may lean on its way: a direction of the tool keeps within a cone round a
/// direction of the world. Turns about that direction are free (a cup that must not be spilt).
struct TiltLimit {
  double max = 0.0872664625997165;                     ///< [rad] in [kLeastTilt, pi/2)
  Eigen::Vector3d axis_T = Eigen::Vector3d::UnitZ();   ///< of the tool, length 1
  Eigen::Vector3d axis_W = -Eigen::Vector3d::UnitZ();  ///< of the world, length 1
};

/// [rad] narrower cones are not planned for.
inline constexpr double kLeastTilt = 1e-3;

/// Whether the numbers of a limit are in their ranges.
[[nodiscard]] bool is_sound(const TiltLimit& limit) noexcept;

/// What points up at `q` shall point up all the way.
/// @param q     shape (dof,) [rad or m], finite.
/// @param max   [rad] as in TiltLimit.
[[nodiscard]] TiltLimit keep_upright(const Arm& arm, std::span<const double> q, double max);

/// The same as a region: all places and turns are free, F has its z axis along `axis_T`.
[[nodiscard]] TaskRegion as_region(const TiltLimit& limit);

/// [rad] by how much the tool leans at `q`, shape (dof,), 0 to pi.
[[nodiscard]] double tilt(const TiltLimit& limit, const Arm& arm, std::span<const double> q);

}  // namespace mjarm
