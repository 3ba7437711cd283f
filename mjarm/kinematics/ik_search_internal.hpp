#pragma once

#include <span>

#include "mjarm/core/rng.hpp"
#include "mjarm/kinematics/chain.hpp"
#include "mjarm/kinematics/descent_internal.hpp"
#include "mjarm/kinematics/ik.hpp"

namespace mjarm::detail {

/// The first option that is out of its range; null where all are within.
[[nodiscard]] const char* option_out_of_range(const IkOptions& options) noexcept;

/// A pose goal and a seed that have passed the checks of check_goal().
struct IkGoal {
  Pose X_WT;      ///< rotation orthonormal to rounding
  JointVec seed;  ///< [rad or m] within the limits
};

/// False for options, a pose or a seed that make no sense; else fills `goal`.
[[nodiscard]] bool check_goal(const Chain& chain, const IkOptions& options, const Pose& X_WT,
                              std::span<const double> q_seed, IkGoal& goal) noexcept;

/// A random start within the limits; joints without stops within 1 m or half a turn of `seed`.
[[nodiscard]] JointVec random_start(const Chain& chain, const JointVec& seed, Rng& rng) noexcept;

/// Another kind of random start: about every third joint that has stops stands at one of them.
[[nodiscard]] JointVec random_start_at_stops(const Chain& chain, const JointVec& seed,
                                             Rng& rng) noexcept;

/// How a descent for these options is run.
[[nodiscard]] DescentOptions descent_options(const IkOptions& options, double length) noexcept;

/// Length [m] that makes position and rotation errors of `chain` comparable.
[[nodiscard]] double characteristic_length(const Chain& chain) noexcept;

}  // namespace mjarm::detail
