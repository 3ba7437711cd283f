#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/planning/way_prover.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm {

/// A planned path in time.
struct PathMotion {
  Trajectory trajectory;  ///< from rest to rest
  double stopping = 0;    ///< [s] what it would take to stop at every corner
};

/// How hard to try. Every default is usable as is.
struct PathMotionOptions {
  std::vector<std::size_t> passed = {};  ///< corners that are met exactly, by index, ascending
  /// To make parts of the motion faster, >= 0, in each of three runs, which mostly end after some
  /// hundreds, when that does not pay any more.
  int attempts = 20'000;
  StopCheck stop = {};  ///< ends the attempts; what was found so far counts
};

/// The fastest motion that is found beside a path of straight edges in joint space, within
/// velocity, acceleration and jerk limits: it begins as one that stops at every corner, of which
/// parts are replaced by faster ones as long as the whole motion is proved free. Same input, same
/// bytes.
/// @param corners  [rad or m] at least 1, each (dof,), neighbours apart; their edges are proved.
/// @param prover   of the paths that they are of.
/// @return an error for sizes, numbers or limits that make no sense.
[[nodiscard]] Result<PathMotion> time_path(std::span<const JointVec> corners,
                                           const JointLimits& limits, const WayProver& prover,
                                           const PathMotionOptions& options = {});

/// The same motion, but for its last part, which goes over into a state that moves instead of to
/// rest: the shortest of those that are proved free, within the limits.
/// @param motion  of time_path(), by the same limits and prover.
/// @param end     where the motion ends, with the velocity and acceleration to have there.
/// @return none where that is not proved, or no faster.
[[nodiscard]] std::optional<Trajectory> lead_into(const Trajectory& motion, const JointState& end,
                                                  const JointLimits& limits,
                                                  const WayProver& prover);

}  // namespace mjarm
