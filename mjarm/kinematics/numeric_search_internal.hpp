#pragma once

#include "mjarm/kinematics/ik_search_internal.hpp"

namespace mjarm::detail {

/// The numeric search of IkSolver: a descent from the seed, then from random starts, until an
/// answer is found that is within `options.max_step` and accepted by `options.valid`. Never
/// allocates.
[[nodiscard]] Result<IkSolution, IkFailure> search_numeric(const Chain& chain,
                                                           const IkOptions& options, double length,
                                                           const IkGoal& goal) noexcept;

/// One descent from the seed: the best attempt at a pose that is known to be out of reach.
[[nodiscard]] IkSolution nearest_from_seed(const Chain& chain, const IkOptions& options,
                                           double length, const IkGoal& goal) noexcept;

}  // namespace mjarm::detail
