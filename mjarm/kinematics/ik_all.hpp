#pragma once

#include <span>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/kinematics/ik.hpp"

namespace mjarm {

/// How widely to look for answers. Every default is usable as is.
struct IkAllOptions {
  int starts = 120;    ///< random starts tried after q_seed, >= 0
  double same = 1e-3;  ///< [rad or m] answers nearer than this in every joint are one, > 0
};

/// The distinct answers that random starts find for X_WT: those of an arm of six joints are its
/// branches, those of a redundant arm are samples. Each stands in the winding nearest to `q_seed`,
/// is within the limits and accepted by `ik.options().valid`. Sorted by the largest joint distance
/// to `q_seed`, nearest first. Same inputs and options().rng_seed, same answer.
/// @return at least one answer, or the failure of `ik.solve()`.
[[nodiscard]] Result<std::vector<IkSolution>, IkFailure> solve_all(
    const IkSolver& ik, const Pose& X_WT, std::span<const double> q_seed,
    const IkAllOptions& options = {});

}  // namespace mjarm
