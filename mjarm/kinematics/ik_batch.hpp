#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "mjarm/kinematics/ik.hpp"

namespace mjarm {

/// How a batch is worked off. Every default is usable as is.
struct IkBatchOptions {
  int threads = 1;  ///< >= 1; 0: as many as the machine runs at once
  /// Told now and then, in the calling thread, how many poses are done. Must not throw.
  std::function<void(std::size_t done)> progress = {};
};

/// Solves many poses, each as `ik.solve()` does: equal bits, whatever the number of threads. Each
/// thread has its own copy of the solver, and so of `ik.options().valid`.
/// @param X_WT    shape (n,).
/// @param q_seed  [rad or m] shape (n, dof) row by row, or (dof,) for one seed of all.
/// @return shape (n,), in the order of the poses; all are bad_input where `q_seed` has another
/// size.
[[nodiscard]] std::vector<Result<IkSolution, IkFailure>> solve_batch(
    const IkSolver& ik, std::span<const Pose> X_WT, std::span<const double> q_seed,
    const IkBatchOptions& options = {});

}  // namespace mjarm
