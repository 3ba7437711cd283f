#pragma once

#include <cstddef>
#include <vector>

#include "mjarm/execution/motion_plan.hpp"
#include "mjarm/program/detour_planner_internal.hpp"
#include "mjarm/program/program_steps_internal.hpp"

namespace mjarm::program::detail {

/// Makes `move` that motion.
void put(DetourMotion motion, PlannedMove& move);

/// Joins detours that follow each other at once into one motion, which passes the goals between
/// them without a stop.
class DetourChain {
 public:
  /// Takes the detour of step `i`, the first of the moves `added`. Where it follows the last of
  /// `moves`, and one motion of both is faster, that becomes this motion and the first added move
  /// is gone.
  void add(std::size_t i, const Step& step, PlannedPath path, DetourPlanner& planner,
           std::vector<PlannedMove>& moves, std::vector<PlannedMove>& added);

  /// The motion that was added last passes into a move that begins in that state, where it can.
  /// @return whether `move`, which is that motion, was changed.
  [[nodiscard]] bool pass_into(const JointState& begin, DetourPlanner& planner,
                               PlannedMove& move) const;

 private:
  std::size_t next_ = 0;  // the step that may go on with it
  std::size_t tool_ = 0;
  double share_ = 1;
  std::vector<PlannedPath> paths_;
};

}  // namespace mjarm::program::detail
