#pragma once

#include <span>
#include <vector>

#include "mjarm/collision/cover_geoms_internal.hpp"
#include "mjarm/collision/solid_scene_internal.hpp"

namespace mjarm::detail {

/// The geoms of the links, in the order of these.
[[nodiscard]] std::vector<LinkSolid> link_solids(const mjModel& m, const Arm& arm,
                                                 std::span<const GeomGroup> links);
/// A geom that does not move, held against every link so far.
[[nodiscard]] StandingSolid standing_solid(const mjModel& m, const PlacedGeom& placed);

}  // namespace mjarm::detail
