#pragma once

#include <span>

#include "mjarm/kinematics/ik.hpp"

namespace mjarm {

/// What an arm with more joints than its task needs does with the freedom left.
enum class PostureGoal {
  near_posture,      ///< least sum of squared distances to a posture
  away_from_limits,  ///< joints near the middle of their limits; without limits they are left alone
  manipulability,    ///< greatest manipulability (fk.hpp), far from singularities
};

/// How a self-motion is sought. Every default is usable as is.
struct SelfMotionOptions {
  PostureGoal goal = PostureGoal::away_from_limits;
  JointVec posture = {};    ///< [rad or m] shape (dof,), for near_posture alone
  int max_steps = 50;       ///< >= 0
  double tolerance = 1e-4;  ///< [rad or m] ends where a step moves the joints less, > 0
};

/// Moves an answer along the self-motion of the arm, the tool at rest within the tolerances of
/// `ik`, to where the goal is best met nearby: projected gradient steps (A. Liegeois, IEEE Trans.
/// SMC 7 (1977) 868), each brought back to the pose by Newton's. Stays within the limits and with
/// what `ik.options().valid` accepts. An arm without freedom keeps its joints.
/// @param X_WT  the pose that `from` reaches.
/// @return an answer that meets the goal at least as well as `from`; bad_input where `from` does
///         not reach the pose, or the sizes or options make no sense.
[[nodiscard]] Result<IkSolution, IkFailure> settle(const IkSolver& ik, const Pose& X_WT,
                                                   std::span<const double> from,
                                                   const SelfMotionOptions& options = {}) noexcept;

}  // namespace mjarm
