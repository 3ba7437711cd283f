#pragma once

#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm::detail {

/// Whether a motion is what was asked for, looked at piece by piece before it is called an answer:
/// every number finite, no jump between two pieces or before the end, velocities, accelerations and
/// (where `with_jerk`) jerks within `limits`. Of pieces of constant jerk the extremes are exact,
/// others are sampled.
/// @param limits  shape (dof,) each; a start or end outside widens those it has to.
/// @return an error that names the joint, the limit and how far it is broken.
[[nodiscard]] Result<void> check_kept(const Trajectory& motion, const JointLimits& limits,
                                      bool with_jerk);

}  // namespace mjarm::detail
