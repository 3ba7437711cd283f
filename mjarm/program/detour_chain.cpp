#include <utility>

#include "mjarm/program/detour_chain_internal.hpp"

namespace mjarm::program::detail {

void put(DetourMotion motion, PlannedMove& move) {
  move.measures = std::move(motion.measures);
  move.trajectory = std::move(motion.motion.trajectory);
  move.stopping = motion.motion.stopping;
  move.corners = std::move(motion.corners);
  move.passed = std::move(motion.passed);
}

void DetourChain::add(std::size_t i, const Step& step, PlannedPath path, DetourPlanner& planner,
                      std::vector<PlannedMove>& moves, std::vector<PlannedMove>& added) {
  constexpr std::size_t kMaxJoined = 8;
  const bool follows = !paths_.empty() && next_ == i && tool_ == step.tool &&
                       share_ == step.share && paths_.size() < kMaxJoined;
  if (!follows) paths_.clear();
  next_ = i + 1;
  tool_ = step.tool;
  share_ = step.share;
  paths_.push_back(std::move(path));
  if (!follows) return;
  PlannedMove& before = moves.back();
  auto joined = planner.timed(paths_, step.share);
  const double apart = before.trajectory.duration() + added.front().trajectory.duration();
  if (!joined || !(joined->motion.trajectory.duration() < apart)) {
    paths_.erase(paths_.begin(), paths_.end() - 1);
    return;
  }
  put(std::move(*joined), before);
  ++before.instructions;
  added.erase(added.begin());
}

bool DetourChain::pass_into(const JointState& begin, DetourPlanner& planner,
                            PlannedMove& move) const {
  MoveMeasures measures;
  if (!planner.lead_into(begin, paths_, share_, move.trajectory, measures)) return false;
  move.measures = std::move(measures);
  move.passes = true;
  return true;
}

}  // namespace mjarm::program::detail
