#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace mjarm::render {

/// Cuts a polyline into dashes along its length. A dash that goes round a corner is two pieces.
/// @param points  shape (n,), finite; any unit, also that of a plot (z = 0).
/// @param dash, gap  lengths in the unit of the points, > 0; longer ones are taken where there
///                   would be more than `max` dashes.
/// @return two ends a piece; empty for fewer than two points or a line without length.
[[nodiscard]] std::vector<Eigen::Vector3d> dashes(std::span<const Eigen::Vector3d> points,
                                                  double dash, double gap, std::size_t max = 1000);

/// A polyline through some of the points only, so that those left out are no further than
/// `tolerance` from it. The first and the last one stay; 64 in a row at most are left out.
/// @param points  shape (n,), finite.
[[nodiscard]] std::vector<Eigen::Vector3d> simplified(std::span<const Eigen::Vector3d> points,
                                                      double tolerance);

}  // namespace mjarm::render
