#pragma once

#include <optional>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/planning/task_region.hpp"

namespace mjarm::app {

/// What a region's words leave out.
enum class Unnamed {
  fixed,  ///< is as in the middle: where a path begins or ends
  free,   ///< may be anything: what a tool keeps within
};

/// Reads a region of the tool, as `frame=can z=2cm yaw=free tool-pos=0,0,0.1`.
/// @param option   the name of the option that has the words.
/// @param X_WT     the tool at the start, which `frame=start` means; none: there is no one start.
/// @return a usage error that names the option and the word.
[[nodiscard]] Result<TaskRegion> parse_region(const std::string& option, const std::string& words,
                                              Unnamed unnamed, const Robot& robot,
                                              const std::optional<Pose>& X_WT);

}  // namespace mjarm::app
