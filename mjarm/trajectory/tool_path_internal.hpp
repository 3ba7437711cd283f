#pragma once

#include "mjarm/core/result.hpp"
#include "mjarm/path/joint_path.hpp"

namespace mjarm::detail {

/// bad_input where waypoints are none, of unequal sizes, not finite or not ascending.
[[nodiscard]] Result<void> check_tool_path(const JointPath& path);

}  // namespace mjarm::detail
