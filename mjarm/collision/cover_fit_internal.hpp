#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mjarm/collision/cover_solid_internal.hpp"
#include "mjarm/collision/sphere_set.hpp"
#include "mjarm/core/stop.hpp"

/// Few spheres that contain the solids of a link.
namespace mjarm::detail {

/// A cover, and by how much it sticks out of the solids at most.
struct FittedCover {
  std::vector<Sphere> spheres;
  double bound = 0;  ///< [m]
};

/// Looks for the fewest spheres that contain all `solids` (not empty) and stick out by at most
/// `bound` [m] > 0. A sphere round a point of depth d may have the radius bound + d, since distance
/// to a convex solid grows by no more than the way: what is left is a set cover of points of the
/// solids by such spheres. That the whole solids are covered is then proved by seal_cover(); points
/// it could not cover are added, until there are none. The same input gives the same spheres.
/// @return nothing where more than `max` spheres are needed, or `stop` ended the work.
[[nodiscard]] std::optional<FittedCover> fit_cover(std::span<const CoverSolid> solids, double bound,
                                                   std::size_t max, const StopCheck& stop = {});

/// Proves that the spheres contain the solids, cutting a box round them into cells until each is in
/// one sphere or in no solid. Cells of the least size grow the sphere that needs it least, up to
/// `bound`.
/// @return points of the solids that could not be covered; none: proved.
[[nodiscard]] std::vector<Eigen::Vector3d> seal_cover(std::span<const CoverSolid> solids,
                                                      std::span<Sphere> spheres, double bound);

}  // namespace mjarm::detail
