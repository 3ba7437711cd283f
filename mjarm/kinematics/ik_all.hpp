#pragma once

#include <span>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/kinematics/ik.hpp"

namespace mjarm {

/// How widely to look for answers. Every default is usable as is.
struct IkAllOptions {
  int starts = 120;       ///< where branches are not computed: random starts after q_seed, >= 0
  double same = 1e-3;     ///< [rad or m] answers nearer than this in every joint are one, > 0
  bool windings = false;  ///< every winding of each answer that the limits leave, not one
  int max = 4096;         ///< answers at most, the nearest are kept, > 0
};

/// The distinct answers for X_WT. Of six hinges all branches: by the closed form, or for any other
/// geometry by GeneralSix, up to 16 (at a singular pose, where a joint is free, samples of their
/// family). Else those that random starts find: the branches of an arm with slides, samples for a
/// redundant one. Each stands in the winding nearest to `q_seed`, or with `options.windings` in
/// every one (a joint without stops: in that), is within the limits and `max_step`, and accepted by
/// `ik.options().valid`. Sorted by the largest joint distance to `q_seed`, then the sum, nearest
/// first. Same inputs and options().seed, same answer.
/// @return at least one answer, or the failure of `ik.solve()`.
[[nodiscard]] Result<std::vector<IkSolution>, IkFailure> solve_all(
    const IkSolver& ik, const Pose& X_WT, std::span<const double> q_seed,
    const IkAllOptions& options = {});

}  // namespace mjarm
