#pragma once

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/kinematics/chain.hpp"
#include "mjarm/kinematics/ik.hpp"

namespace mjarm::detail {

/// When a descent ends.
struct DescentOptions {
  double pos_tol = 1e-7;     ///< [m]
  double rot_tol = 1e-7;     ///< [rad]
  int max_iterations = 100;  ///< steps, > 0
  double length = 0.5;       ///< [m] position error that weighs as much as 1 rad, > 0
  bool limits = true;        ///< false: the limits are ignored
  /// True: a joint that a step would carry past its limit goes there, and the others take over what
  /// it leaves; false: each is cut by itself, which is quicker and loses its way among many limits.
  bool share = false;
  IkTask task = IkTask::pose;
  double damping = 1e-12;  ///< [rad^2] least damping of a step, >= 0
};

/// Where a descent ended.
struct Descent {
  JointVec q;          ///< [rad or m]; hinges of a full turn may be outside their limits
  double pos_err = 0;  ///< [m]
  double rot_err = 0;  ///< [rad]
  double error = 0;    ///< weighted square sum that was minimised [rad^2]
  int iterations = 0;
  bool converged = false;
};

/// Walks from `q_start` (within the limits) down the weighted pose error to X_WT by damped least
/// squares. Never allocates. The result keeps the best configuration met.
[[nodiscard]] Descent descend(const Chain& chain, const Pose& X_WT, const JointVec& q_start,
                              const DescentOptions& options) noexcept;

}  // namespace mjarm::detail
