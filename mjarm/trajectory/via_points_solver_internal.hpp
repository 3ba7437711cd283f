#pragma once

#include <optional>
#include <span>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/trajectory/limits_internal.hpp"
#include "mjarm/trajectory/via_points_newton_internal.hpp"

namespace mjarm::detail {

/// The fastest motion within `bounds` that covers `steps` one after another, from rest to rest, as
/// far as an interior point method gets in `iterations` steps; at its limits after a last uniform
/// scaling of time.
/// @param steps  [rad or m] from waypoint to waypoint, at least one; finite, none all zero.
/// @return none where numbers overflow on the way.
[[nodiscard]] std::optional<ViaSpline> fastest_via(std::span<const JointVec> steps,
                                                   const Bounds& bounds, int iterations);

/// Coefficients of joint `j` in segment `k`.
[[nodiscard]] Coefs coefs_of(const ViaSpline& motion, int k, int j);

}  // namespace mjarm::detail
