#pragma once

#include "mjarm/core/result.hpp"

namespace mjarm::app {

/// A planned motion in wrong worlds.
struct ClearanceResult {
  int worlds = 0;
  int contacts = 0;    ///< worlds in which the arm touched anything
  double planned = 0;  ///< [m] least distance that the plan keeps
  double tube = 0;     ///< [m] farthest that a joint or the tool was from the plan, in any world
};

/// The UR5e round the wall of its scene, planned with `margin` [m] to everything, at a quarter of
/// its limits, by `robust` in `worlds` worlds drawn from `seed`.
[[nodiscard]] Result<ClearanceResult> clearance_in_wrong_worlds(double margin, int worlds,
                                                                int seed);

}  // namespace mjarm::app
