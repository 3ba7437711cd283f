#pragma once

#include <optional>

#include "mjarm/perception/depth_scene_internal.hpp"
#include "mjarm/perception/find_objects.hpp"
#include "mjarm/perception/raster_internal.hpp"

namespace mjarm::perception {

/// The box or cylinder, upright on the table, that explains a cluster best; nothing without a
/// table, or where the cluster is too large to be something on it.
[[nodiscard]] std::optional<UnknownObject> measure_unknown(const DepthScene& scene, int cluster,
                                                           Raster& raster);

}  // namespace mjarm::perception
