#pragma once

#include <vector>

#include "mjarm/program/program_plan.hpp"
#include "mjarm/program/urscript.hpp"
#include "mjarm/program/urscript_clock_internal.hpp"

namespace mjarm::program::detail {

/// Where one statement of a script brings the tool.
struct UrTarget {
  enum class Word { line, turn, arc, process };

  Word word = Word::line;  ///< movel, movel by time, movec, movep
  Pose X_WT = {};
  Pose X_via = {};       ///< arc
  double speed = 0;      ///< [m/s]
  double accel = 0;      ///< [m/s^2]
  double time = 0;       ///< [s] turn
  double radius = 0;     ///< [m] blend at the target; 0: it rests there
  FilePlace place = {};  ///< of its instruction
};

/// The statements that walk `move.curve`: straight moves with their blends, turns on the spot, arcs
/// whose orientation turns evenly, and else points of the curve within the tolerances.
[[nodiscard]] std::vector<UrTarget> ur_targets(const PlannedMove& move, const Arm& arm,
                                               const UrscriptOptions& options);

}  // namespace mjarm::program::detail
