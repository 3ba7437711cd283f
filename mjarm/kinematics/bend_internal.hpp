#pragma once

#include <Eigen/Core>
#include <span>

#include "mjarm/kinematics/ik.hpp"

namespace mjarm::detail {

/// Where an arm is seen to bend in one configuration.
struct Bend {
  bool has_elbow = false;  ///< false for fewer than four joints
  bool closed = false;     ///< the rest is known: an arm of six or seven axes in closed form
  /// From the line shoulder - wrist to the elbow, across it [m]; of six axes within the plane in
  /// which shoulder and elbow move.
  Eigen::Vector3d aside = Eigen::Vector3d::Zero();
  /// Says on which side it is where that is neither above nor below the line.
  double turn = 0;
  double left = 0;   ///< > 0: the arm, or its elbow, is left of the line base axis - wrist
  double wrist = 0;  ///< sine-like: its sign says to which side the wrist is bent
};

/// The bend of an arm at `q`, shape (dof,). Never allocates.
[[nodiscard]] Bend bend_of(const IkSolver& ik, std::span<const double> q) noexcept;

}  // namespace mjarm::detail
