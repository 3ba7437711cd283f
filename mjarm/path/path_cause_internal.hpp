#pragma once

#include <span>

#include "mjarm/path/track_search_internal.hpp"

namespace mjarm::detail {

/// Why no track goes on to poses[track.size()]: looks at how the best ones would go on if they knew
/// no limits, touched nothing and had any time. Fills everything but `partial`.
[[nodiscard]] PathFailure find_cause(const PathLayers& layers, std::span<const Pose> poses,
                                     const Track& track, const JointVec& q_start);

}  // namespace mjarm::detail
