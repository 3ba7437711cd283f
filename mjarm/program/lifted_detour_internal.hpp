#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "mjarm/program/program_plan.hpp"
#include "mjarm/program/workplaces_internal.hpp"

namespace mjarm::program::detail {

/// A way round obstacles, from a place where something lies on something else, or to one.
struct LiftedDetour {
  std::vector<PlannedMove> before;  ///< off what it lies on, where that was needed
  DetourMotion motion;
  std::vector<PlannedMove> after;  ///< down to what it shall lie on
  std::size_t goal = 0;            ///< index of the goal reached
};

/// What is asked of a detour.
struct DetourWish {
  double share;                     ///< of the joints' velocity and acceleration limits, (0, 1]
  std::optional<double> clearance;  ///< [m] as in PlanOptions
};

/// Adds a straight joint move, which is looked at exactly, to `moves`; false where it touches
/// something.
using MoveTo = std::function<bool(const JointVec& from, const JointVec& to, const char* word,
                                  std::vector<PlannedMove>& moves)>;

/// A detour as DetourPlanner plans it. Spheres round a part that lies on a table are in the table,
/// and those round fingers in what is between them: where start or goals are hit for that reason
/// the tool is first moved off, and last down, by 30 mm, straight up or back along its own axis.
[[nodiscard]] Result<LiftedDetour, DetourFault> plan_lifted(Tool& with, const JointVec& q,
                                                            std::span<const JointVec> goals,
                                                            const DetourWish& wish,
                                                            const MoveTo& move_to);

}  // namespace mjarm::program::detail
