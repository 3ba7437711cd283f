#pragma once

#include <span>
#include <vector>

#include "mjarm/path/track_search_internal.hpp"

namespace mjarm::detail {

/// Spreads what the arm does besides following its poses over the whole of a track: motions of a
/// redundant arm within itself, and turns of the tool within the tolerance. Joints then move evenly
/// from the first answer to the last, which is free to move on. A search does such things all at
/// once where it gets tight, for which a timed motion would nearly stop.
/// @param s      parameter of each pose, ascending.
/// @param track  an answer to every pose; it stays as it is where an even one would be tighter.
void even_out(const PathLayers& layers, std::span<const Pose> poses, std::span<const double> s,
              Track& track);

}  // namespace mjarm::detail
