#pragma once

#include <functional>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm {

/// Torque of every joint [N m or N] that moves the arm with velocity `v` and acceleration `a` at
/// `q`, shape (dof,) each: linear in `a`; quadratic in `v`, with viscous and dry friction. Empty
/// where torques do not matter. `ArmDynamics::inverse` is one.
using InverseDynamics =
    std::function<JointVec(const JointVec& q, const JointVec& v, const JointVec& a)>;

/// Worst torque of each joint over a trajectory as a share of `torque` (dof,), > 0. Samples it
/// every `dt` [s] (> 0) and at its end; shares no code with the timers.
[[nodiscard]] JointVec check_torque(const Trajectory& trajectory, const InverseDynamics& dynamics,
                                    const JointVec& torque, double dt = 0.001);

}  // namespace mjarm
