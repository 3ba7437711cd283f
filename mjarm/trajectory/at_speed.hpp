#pragma once

#include <span>

#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/path/joint_path.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm {

/// time_tool_path() for a tool that is already on its way: the first state has the speed that is
/// asked for there, as far as the joints can, and not that of a rest. The path is timed with a
/// run-up before it, along its first cubic, which is then left out.
/// @return also an error where rounding spoils the run-up.
[[nodiscard]] Result<Trajectory> time_tool_path_at_speed(const JointPath& path,
                                                         std::span<const double> stops,
                                                         const JointLimits& limits,
                                                         const TimingOptions& options = {});

/// What a trajectory does from `from` to `to`; its ends move where it does there.
/// @param from,to  [s] 0 <= from < to <= duration().
[[nodiscard]] Result<Trajectory> part_of(const Trajectory& trajectory, double from, double to);

}  // namespace mjarm
