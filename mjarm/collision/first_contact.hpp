#pragma once

#include <optional>
#include <span>

#include "mjarm/collision/exact.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"

namespace mjarm {

/// Where an edge first touches something.
struct EdgeContact {
  double t = 0;          ///< on the edge, 0 to 1
  ContactPoint contact;  ///< the deepest there
};

/// Walks the straight edge q(t) = q0 + t (q1 - q0) with MuJoCo's own collision detection, both ends
/// included. Samples prove nothing between them; verify_edge() does.
/// @param q0, q1  shape (dof,) [rad or m]; limits are not looked at.
/// @param step    [rad or m, L2] largest spacing, > 0.
/// @return nothing where every sample is free; bad_input for a wrong size, a number that is not
/// finite, or a step that cuts the edge into more than 1e8 pieces; stopped() where `stop` ended the
/// work.
[[nodiscard]] Result<std::optional<EdgeContact>> first_contact(ExactChecker& checker,
                                                               std::span<const double> q0,
                                                               std::span<const double> q1,
                                                               double step = 0.005,
                                                               const StopCheck& stop = {});

}  // namespace mjarm
