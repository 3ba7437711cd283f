#pragma once

#include <optional>
#include <span>
#include <string>

#include "mjarm/model/arm.hpp"
#include "mjarm/path/path_fix.hpp"
#include "mjarm/path/path_measures.hpp"

namespace mjarm::app {

/// Appends the members of a solved path, from `"ok":true` on, without the closing brace.
void append_path(std::string& out, const JointPath& path, const PathMeasures& measures);

/// Likewise of one that stops; `measures` are of the part before, none where there is no such part.
void append_path_failure(std::string& out, const PathFailure& failure,
                         std::span<const PathFix> fixes, const Arm& arm,
                         const std::optional<PathMeasures>& measures, bool partial);

/// Appends the runs of given poses that have no answer at all, as `"unreachable":[[first,last]]`.
void append_unreachable(std::string& out, std::span<const UnreachableRange> ranges);

}  // namespace mjarm::app
