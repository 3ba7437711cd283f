#pragma once

#include "mjarm/core/json.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/planning/plan_file.hpp"

namespace mjarm::detail {

/// Writes a region that a path keeps, and the room that it has there, as an object:
/// `{"frame":{"pos":[3],"quat":[4]},"tool":{...},"min":[6],"max":[6],"lean":rad,"room":{"place":m,
/// "turn":rad}}`, and with a mechanism `"mechanism":{"type":"hinge","pos":[3],"axis":[3],"min":rad,
/// "max":rad}`, or a `"slide"` in m. Bounds are those of x, y, z [m] and roll, pitch, yaw [rad];
/// null stands for what is not bounded.
void append_kept_region(JsonWriter& json, const TaskRegion& region, const RegionRoom& room);

/// Reads it.
/// @return an error that names the member.
[[nodiscard]] Result<GivenRegion> read_kept_region(const JsonValue& entry);

}  // namespace mjarm::detail
