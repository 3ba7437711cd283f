#pragma once

#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/model/surface.hpp"

namespace mjarm::perception {

/// Of a solid of revolution so many turns stand for all.
inline constexpr int kRoundTurns = 8;

/// The rotations that bring a surface onto itself, within 0.25 mm (root mean square): in pose X_WO
/// and in X_WO * S it looks the same, for each S. They turn about its middle and form a group, the
/// first is none at all. Looked for about the axes of its inertia and of its largest faces; at most
/// 60, as an icosahedron has.
[[nodiscard]] std::vector<Pose> symmetries(const Surface& surface);

}  // namespace mjarm::perception
