#pragma once

#include <span>

#include "mjarm/kinematics/ik.hpp"

namespace mjarm {

/// What an arm with more joints than its task needs does with the freedom left.
enum class PostureGoal {
  near_posture,      ///< least sum of squared distances to a posture
  away_from_limits,  ///< joints near the middle of their limits; those without are left alone
  manipulability,    ///< greatest manipulability() of the whole Jacobian: far from singularities
};

/// How a self-motion is sought. Every default is usable as is.
struct SelfMotionOptions {
  PostureGoal goal = PostureGoal::away_from_limits;
  JointVec posture = {};    ///< [rad or m] shape (dof,), for near_posture alone
  int max_steps = 100;      ///< >= 0
  double tolerance = 1e-4;  ///< [rad or m] ends where a step moves every joint less, > 0
};

/// Moves an answer along the self-motion of the arm, the tool at rest within the tolerances of
/// `ik`, to where the goal is best met nearby: projected gradient steps (A. Liegeois, IEEE Trans.
/// SMC 7 (1977) 868), each brought back to the pose by Newton's. What it ends at is within the
/// limits, within `max_step` of `from` and accepted by `valid` (of `ik.options()`); on the way
/// there nothing but its steps is looked at. An arm without freedom keeps its joints.
/// @param X_WT  the pose that `from` reaches.
/// @param from  [rad or m] shape (dof,), an answer of `ik`.
/// @return an answer that meets the goal at least as well as `from`, `iterations` = steps taken;
///         bad_input where `from` does not reach the pose, or the sizes or options make no sense;
///         collision where `valid` refuses `from`. Never throws, never allocates (but for what
///         `valid` does).
[[nodiscard]] Result<IkSolution, IkFailure> null_space_step(
    const IkSolver& ik, const Pose& X_WT, std::span<const double> from,
    const SelfMotionOptions& options = {}) noexcept;

}  // namespace mjarm
