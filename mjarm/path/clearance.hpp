#pragma once

#include <functional>
#include <limits>
#include <span>

#include "mjarm/collision/exact.hpp"

namespace mjarm {

/// How far an arm is from touching anything.
struct Clearance {
  double distance = std::numeric_limits<double>::infinity();  ///< [m] < 0: overlap by so much
  GeomPair pair;                                              ///< the two that are nearest
};

/// Measures a configuration, shape (dof,) [rad or m]. Must not throw.
using ClearanceCheck = std::function<Clearance(std::span<const double> q)>;

/// By the exact checker, a copy of which the result holds; distances beyond the checker's margin
/// count as infinite. Copies share that checker, so each thread needs a check of its own.
[[nodiscard]] ClearanceCheck clearance_check(const ExactChecker& checker);

}  // namespace mjarm
