#pragma once

#include "mjarm/core/result.hpp"
#include "mjarm/trajectory/speed_profile_internal.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm::detail {

/// A fast motion along `spline` from rest to rest that keeps all bounds at every moment, those on
/// jerks as well. It always ends with an answer: where nothing better is found, a slower motion.
[[nodiscard]] Result<Trajectory> time_smoothly(const CubicSpline& spline, const Bounds& bounds,
                                               const PathBounds& path_bounds);

}  // namespace mjarm::detail
