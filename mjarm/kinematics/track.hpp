#pragma once

#include <span>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/kinematics/link_chain.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm {

/// How a tool is led. Every default is usable as is.
struct TrackOptions {
  double dt = 0.002;            ///< [s] from one call to the next, > 0
  double gain = 1;              ///< share of the pose error taken off in a call, in (0, 1]
  double speed_share = 1;       ///< share of the joints' greatest speed that may be used, in (0, 1]
  double near_singular = 0.05;  ///< [1] damping begins where the manipulability falls below this
                                ///< share of that of the middle configuration, > 0
  double damping = 0.05;        ///< [1] greatest damping, at the singularity itself, > 0
};

/// One step of servoing.
struct TrackStep {
  JointVec q;              ///< [rad or m] where to go, within the limits
  double pos_err = 0;      ///< [m] of the tool before the step
  double rot_err = 0;      ///< [rad] likewise
  double damping = 0;      ///< what was used: 0 away from singularities
  double speed_scale = 1;  ///< < 1 where the greatest speed slowed the whole step down
  int held = 0;            ///< joints that stand at a limit
  bool ok = false;         ///< false for NaN, a matrix that is no rotation or a wrong
                           ///< size: q = input
};

/// Differential inverse kinematics for servoing: leads the tool towards a pose
/// that may change with every call. A value; never allocates, never throws.
class Tracker {
 public:
  explicit Tracker(const Arm& arm, const TrackOptions& options = {});

  /// One damped step from `q` towards X_WT: dq = W J^T (J W J^T + d^2 I)^-1
  /// gain e, where d grows towards singularities (Y. Nakamura and H. Hanafusa,
  /// J. Dyn. Sys. Meas. Control 108 (1986) 163) and W takes joints out that
  /// stand at a limit and would be pushed beyond it. Then the whole step is
  /// shortened until no joint is faster than it may be, so that the tool keeps
  /// its direction.
  /// @param q  [rad or m] shape (dof,), within the limits.
  [[nodiscard]] TrackStep step(const Pose& X_WT, std::span<const double> q) const noexcept;

 private:
  LinkChain chain_;
  JointVec lower_, upper_;  // [rad or m]
  TrackOptions options_;
  JointVec max_;          // [rad or m] farthest a joint may move in a call
  double length_ = 1;     // [m] position error that weighs as much as 1 rad
  double threshold_ = 0;  // manipulability below which the step is damped
};

}  // namespace mjarm
