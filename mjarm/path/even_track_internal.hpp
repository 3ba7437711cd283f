#pragma once

#include <span>
#include <vector>

#include "mjarm/path/track_search_internal.hpp"

namespace mjarm::detail {

/// Spreads the motion of a redundant arm within itself over the whole of a track: the tool stays
/// where it is at each pose, and joints move evenly from the first answer to the last, which is
/// free to move on. A search that steps aside where it gets tight does so all at once, for which a
/// timed motion would nearly stop.
/// @param s      parameter of each pose, ascending.
/// @param track  an answer to every pose; it stays as it is where an even one would be tighter.
void even_out(const PathLayers& layers, std::span<const Pose> poses, std::span<const double> s,
              Track& track);

}  // namespace mjarm::detail
