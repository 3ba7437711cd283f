#pragma once

#include <span>
#include <string>
#include <string_view>

#include "mjarm/kinematics/ik.hpp"

namespace mjarm {

/// Which part of an arm loses a direction of motion.
enum class SingularKind {
  none,      ///< far from any
  shoulder,  ///< the wrist centre where the first joint cannot move it sideways
  elbow,     ///< the arm stretched or folded
  wrist,     ///< the last axis parallel to an earlier one
  other,     ///< an arm without a closed form of six axes: not told apart
};

/// "none", "shoulder", "elbow", "wrist" or "other".
[[nodiscard]] std::string_view name(SingularKind kind) noexcept;
/// The same in the user's language; empty for none.
[[nodiscard]] std::string describe(SingularKind kind);

/// How near a configuration is to a singularity.
struct Singularity {
  SingularKind kind = SingularKind::none;  ///< the nearest, none where
                                           ///< `smallest` is above the bound
  double smallest = 0;                     ///< smallest singular value of J_W [mixed units]
};

/// @param q     [rad or m] shape (dof,).
/// @param near  bound on the smallest singular value below which `q` counts as
/// near.
[[nodiscard]] Singularity singularity(const IkSolver& ik, std::span<const double> q,
                                      double near = 0.02) noexcept;

}  // namespace mjarm
