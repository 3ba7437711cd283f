#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mjarm/collision/fast_check.hpp"
#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/planning/tilt_limit.hpp"

namespace mjarm {

/// Where a tool may end: a box of places and a cone of directions round a pose (a task space region
/// as D. Berenson et al., IJRR 30 (2011) 1435, have it). With all tolerances 0 the pose itself.
struct GoalRegion {
  Pose X_WR;                                       ///< the middle R
  Eigen::Vector3d half = Eigen::Vector3d::Zero();  ///< [m] 0 to 10: p_RT lies in +-half
  /// `lean` and `turn` are nothing to a solver whose task is a position.
  double lean = 0;  ///< [rad] 0 to pi: between z of T and of R
  double turn = 0;  ///< [rad] 0 to pi: of T about its own z
};

/// Whether its tolerances are in their ranges.
[[nodiscard]] bool is_sound(const GoalRegion& region) noexcept;

/// Which configurations stand for a region. Every default is usable as is.
struct GoalOptions {
  int poses = 16;          ///< drawn in the region besides its middle, >= 0
  int max = 64;            ///< configurations at most, the nearest to `q_near` are kept, > 0
  std::uint64_t seed = 1;  ///< same input and seed, same goals
  /// Goals that lean farther are left out, where there are others.
  std::optional<TiltLimit> tilt = {};
  StopCheck stop = {};  ///< ends the drawing of poses: what was found so far counts
};

/// Goals for plan_path(): all branches of inverse kinematics, in every winding, of the region's
/// middle and of poses drawn evenly in it. Those free of collisions; where none is, those in
/// collision, so that the planner can say what is hit.
/// @param ik      of the arm of `checker`; with `task` position or axis any orientation, or turn,
/// will do.
/// @param q_near  shape (dof,) [rad or m].
/// @return shape (n,), n >= 1, nearest to `q_near` first; or why the middle has no answer, where
/// no drawn pose has one either (bad_input: also an option out of range).
[[nodiscard]] Result<std::vector<JointVec>, IkFailure> goals_in(const FastChecker& checker,
                                                                const IkSolver& ik,
                                                                const GoalRegion& region,
                                                                std::span<const double> q_near,
                                                                const GoalOptions& options = {});

}  // namespace mjarm
