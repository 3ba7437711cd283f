#pragma once

#include <Eigen/Core>
#include <span>

#include "mjarm/model/arm.hpp"

namespace mjarm {

/// The tool's speeds v = J qd that joint speeds with |qd| <= 1 can give, an ellipsoid about the
/// tool's origin.
struct VelocityEllipsoid {
  Eigen::Matrix3d R_WE;       ///< rotation matrix, columns = principal axes in the world frame
  Eigen::Vector3d semi_axes;  ///< [m/s a unit of joint speed] descending, >= 0; 0 = cannot move so
};

/// The manipulability ellipsoid of the tool's position: principal axes and singular values of the
/// upper three rows of the Jacobian, whose squares are the eigenvalues of J J^T (T. Yoshikawa,
/// IJRR 4 (1985) 3). With slides and hinges in one arm a metre counts as a radian.
/// @param q  shape (dof,) [rad or m], finite.
[[nodiscard]] VelocityEllipsoid manipulability_ellipsoid(const Arm& arm, std::span<const double> q);

}  // namespace mjarm
