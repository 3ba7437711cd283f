#pragma once

#include <span>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/path/solve_path.hpp"

namespace mjarm {

/// A shift of the whole path [m, world] that makes every pose reachable without a joint step over
/// max_step, verified by solving it. Shifts are multiples of 0.05 m along the world's axes, so that
/// people can read them; the shortest is taken, of equal ones that along the fewest axes. Zero
/// where the path needs none.
/// @param reach  [m] longest shift tried, >= 0 (at most 1 is used).
/// @return impossible where none was found within `reach` and a bounded number of tries.
[[nodiscard]] Result<Eigen::Vector3d> find_shift(const IkSolver& ik, std::span<const Pose> poses,
                                                 std::span<const double> q_seed,
                                                 const PathOptions& options = {},
                                                 double reach = 0.4);

}  // namespace mjarm
