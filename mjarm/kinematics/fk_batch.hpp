#pragma once

#include <span>

#include "mjarm/core/pose.hpp"
#include "mjarm/kinematics/chain.hpp"

namespace mjarm {

/// Poses X_WT of the tool for many configurations at once, as many at a time as the registers of
/// this machine hold. What comes out for a configuration does not depend on its neighbours; it is
/// that of fk() to rounding.
/// @param q     [rad or m] shape (n, dof), row by row, |q| < 1e5.
/// @param X_WT  shape (n,).
void fk_batch(const Chain& chain, std::span<const double> q, std::span<Pose> X_WT) noexcept;

/// The same in single precision, to about 1e-6 m and rad for an arm of 1 m.
/// @param q     [rad or m] shape (n, dof), row by row, |q| < 100.
/// @param X_WT  shape (n, 12): position [m], then the columns of the rotation matrix.
void fk_batch(const Chain& chain, std::span<const float> q, std::span<float> X_WT) noexcept;

}  // namespace mjarm
