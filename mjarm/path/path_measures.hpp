#pragma once

#include <cstddef>
#include <span>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/path/clearance.hpp"

namespace mjarm {

/// The least of something along a path, and the index of its waypoint.
struct LeastAlong {
  double value = 0;
  std::size_t at = 0;
};

/// How near a path comes to what it should keep away from.
struct PathMeasures {
  LeastAlong manipulability;  ///< see manipulability() [mixed units]
  LeastAlong singular_value;  ///< smallest singular value of the Jacobian [mixed units]
  LeastAlong limit_room;      ///< [rad or m] from the nearest limit; infinite where there is none
  LeastAlong clearance;       ///< [m] infinite where it was not looked at
};

/// Measured at the waypoints `q`, of which there is at least one.
/// @param stop  ends the work: the rest of the waypoints is not looked at then.
[[nodiscard]] PathMeasures measure_path(const Arm& arm, std::span<const JointVec> q,
                                        const ClearanceCheck& clearance = {},
                                        const StopCheck& stop = {});

}  // namespace mjarm
