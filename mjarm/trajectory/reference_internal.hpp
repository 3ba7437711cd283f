#pragma once

#include <cstddef>
#include <vector>

#include "mjarm/trajectory/smooth_profile_internal.hpp"
#include "mjarm/trajectory/spline_internal.hpp"

namespace mjarm::detail {

/// A reference motion along a path, sampled at all its waypoints and often enough for the time law.
struct Reference {
  std::vector<double> tau;         ///< [s] ascending from 0
  std::vector<PathState> states;   ///< there
  std::vector<std::size_t> piece;  ///< of the spline, after each sample (the last: before it)
  std::vector<std::size_t> law;    ///< samples where the time law has its knots, both ends included
};

/// Cells a time law along `spline` needs: many between two waypoints, as far as there are not too
/// many of those.
[[nodiscard]] double law_cells(const CubicSpline& spline);

/// Samples `smooth`, made of `profile` by a window of `window` [s], along `spline`: at all
/// waypoints and at least so often that `cells` of equal time would do. Where waypoints are too
/// many, only some of them are knots of the time law.
[[nodiscard]] Reference reference_along(const CubicSpline& spline, const SmoothProfile& smooth,
                                        const SpeedProfile& profile, double window, double cells);

}  // namespace mjarm::detail
