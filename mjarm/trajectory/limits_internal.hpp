#pragma once

#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/trajectory/inverse_dynamics.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm::detail {

/// What the joints may do in one timing: the limits times the share asked for.
struct Bounds {
  JointVec v;                     ///< [rad/s or m/s] > 0
  JointVec a;                     ///< [rad/s^2 or m/s^2] > 0
  JointVec j;                     ///< [rad/s^3 or m/s^3] > 0
  JointVec torque = {};           ///< [N m or N] > 0; not used without `dynamics`
  InverseDynamics dynamics = {};  ///< empty: torques do not matter
};

/// Bounds of `dof` joints, or an error that says which numbers make no sense.
[[nodiscard]] Result<Bounds> bounds_of(const JointLimits& limits, const TimingOptions& options,
                                       Eigen::Index dof);

}  // namespace mjarm::detail
