#pragma once

#include <vector>

#include "mjarm/core/stop.hpp"
#include "mjarm/planning/way_prover.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm::detail {

/// A place that a motion has to go through.
struct MetPlace {
  double t = 0;  ///< [s] when it does
  JointVec q;
};

/// A faster motion, as long as that pays: again and again what it does between two random moments
/// is replaced by the fastest motion from its state at the one to that at the other (K. Hauser and
/// V. Ng-Thow-Hing, ICRA 2010, here within jerk limits), or by two such motions over a random state
/// beside it, where that is proved. Same input, same bytes.
/// @param met       by time; of `motion`.
/// @param attempts  at most, in each of a few runs.
[[nodiscard]] Trajectory shortened_in_time(const JointLimits& limits, const WayProver& prover,
                                           const std::vector<MetPlace>& met, int attempts,
                                           const StopCheck& stop, const Trajectory& motion);

}  // namespace mjarm::detail
