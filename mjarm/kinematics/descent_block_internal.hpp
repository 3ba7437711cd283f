#pragma once

#include "mjarm/kinematics/block_internal.hpp"
#include "mjarm/kinematics/chain.hpp"
#include "mjarm/kinematics/descent_internal.hpp"

namespace mjarm::detail {

/// kBlock descents to one pose, side by side.
struct DescentBlock {
  double q[kMaxDof][kBlock];     ///< [rad or m] within the limits; those of hinges of a full turn
                                 ///< may leave them
  double next[kMaxDof][kBlock];  ///< the same after one more step
  /// Weighted square error at `q` [rad^2], as in descend(); of a rotation by an angle t it counts
  /// (2 sin(t / 2))^2.
  double error[kBlock];
};

/// Takes one step of damped least squares in every lane: from `block.q` fills `error` and `next`.
using DescentKernel = void (*)(const Chain& chain, const Pose& X_WT, const DescentOptions& options,
                               DescentBlock& block);
void descent_step_baseline(const Chain&, const Pose&, const DescentOptions&, DescentBlock&);
#if defined(__x86_64__)
void descent_step_avx2(const Chain&, const Pose&, const DescentOptions&, DescentBlock&);
void descent_step_avx512(const Chain&, const Pose&, const DescentOptions&, DescentBlock&);
#endif

/// The widest one that this machine runs.
[[nodiscard]] DescentKernel descent_kernel() noexcept;

}  // namespace mjarm::detail
