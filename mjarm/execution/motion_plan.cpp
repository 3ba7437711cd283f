#include "mjarm/execution/motion_plan.hpp"

#include <algorithm>
#include <utility>

#include "mjarm/kinematics/fk.hpp"

namespace mjarm {

MotionPlan MotionPlan::of(const Arm& arm, Trajectory trajectory) {
  MotionPlan plan;
  plan.arms.push_back(arm);
  plan.q_start = trajectory.at(0).q;
  plan.moves.push_back({.trajectory = std::move(trajectory)});
  return plan;
}

double MotionPlan::duration() const {
  double sum = 0;
  for (const PlannedMove& move : moves) sum += move.trajectory.duration();
  return sum;
}

JointVec MotionPlan::q_end() const {
  if (moves.empty()) return q_start;
  const Trajectory& last = moves.back().trajectory;
  return last.at(last.duration()).q;
}

bool MotionPlan::presses() const {
  return std::ranges::any_of(moves, [](const PlannedMove& one) { return one.press.has_value(); });
}

MotionPart MotionPlan::part(std::size_t move) const {
  const bool pressing = presses();
  const auto has_way = [&](const PlannedMove& one) {
    return pressing ? one.press.has_value() : one.curve || !one.corners.empty();
  };
  if (moves[move].is_approach()) return MotionPart::approach;
  if (has_way(moves[move]) || std::ranges::none_of(moves, has_way)) return MotionPart::work;
  return MotionPart::travel;
}

std::vector<Pose> planned_tool_path(const PlannedMove& move, const Arm& arm) {
  constexpr int kPieces = 60;  // of a joint move
  if (move.curve) return move.curve->poses(move.curve->stations(0.01, 0.1));
  std::vector<Pose> out;
  if (!move.measures && !move.is_approach()) return out;
  for (int i = 0; i <= kPieces; ++i) {
    const double t = move.trajectory.duration() * i / kPieces;
    out.push_back(fk(arm, as_span(move.trajectory.at(t).q)));
  }
  return out;
}

}  // namespace mjarm
