#pragma once

#include <Eigen/Core>

#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// The space between the fingers of an open gripper, as its collision geometry has it, in the frame
/// T of the arm's tool. Its axes are orthonormal: the fingers close along `close_T`, come up to
/// things along `approach_T`, and `side_T` = approach x close.
struct Jaws {
  Eigen::Vector3d center_T = Eigen::Vector3d::Zero();  ///< [m] midway between the open fingers
  Eigen::Vector3d close_T = Eigen::Vector3d::UnitY();
  Eigen::Vector3d approach_T = Eigen::Vector3d::UnitZ();
  double opening = 0;     ///< [m] between the open fingers, along close_T through the centre
  double half_width = 0;  ///< [m] of the fingers' surfaces, along side_T from the centre
  double tips = 0;        ///< [m] from the centre to where the fingers end, along approach_T
  double palm = 0;        ///< [m] from the centre to what is behind it, against approach_T

  [[nodiscard]] Eigen::Vector3d side_T() const { return approach_T.cross(close_T); }
};

/// Opens the gripper in a simulation without gravity, the arm at home, and measures by rays:
/// whatever drives the fingers (slides, tendons, linkages with closed loops), what counts is where
/// they stand. The jaws are at the tool frame where that is between the fingers, else (at the
/// flange, beyond their tips) near the fingertips, on the line through the middle of the fingers.
/// @return not_available where the arm has no gripper, or nothing lies between its fingers.
[[nodiscard]] Result<Jaws> find_jaws(const Model& model, const Arm& arm);

}  // namespace mjarm
