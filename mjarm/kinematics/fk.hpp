#pragma once

#include <span>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm {

/// Pose X_WT of the tool in the world at joint values `q`, shape (dof,) [rad or m].
[[nodiscard]] Pose fk(const Arm& arm, std::span<const double> q) noexcept;

/// Poses X_WJ of all joint frames after their motion, into `X_WJ` (at least dof); returns X_WT.
Pose fk_all(const Arm& arm, std::span<const double> q, std::span<Pose> X_WJ) noexcept;

/// Pose of the tool and its Jacobian in one pass.
struct FkJacobian {
  Pose X_WT;
  Jacobian J_W;  ///< 6 x dof geometric Jacobian at the tool's origin, world axes: v = J_W(0:3) qd
};
[[nodiscard]] FkJacobian fk_jacobian(const Arm& arm, std::span<const double> q) noexcept;

/// sqrt(det(J J^T)) for dof >= 6, sqrt(det(J^T J)) below [mixed units] (T. Yoshikawa, IJRR 4
/// (1985)).
[[nodiscard]] double manipulability(const Jacobian& J) noexcept;

/// Smallest singular value of J; 0 at a singularity.
[[nodiscard]] double smallest_singular_value(const Jacobian& J) noexcept;

/// True where every joint value is finite and within [lower, upper], with `slack` [rad or m] to
/// spare.
[[nodiscard]] bool within_limits(const Arm& arm, std::span<const double> q,
                                 double slack = 0) noexcept;

/// `q` moved into the limits.
[[nodiscard]] JointVec clamp_to_limits(const Arm& arm, std::span<const double> q) noexcept;

}  // namespace mjarm
