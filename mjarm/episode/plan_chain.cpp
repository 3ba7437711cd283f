#include <algorithm>
#include <iterator>
#include <utility>

#include "mjarm/episode/plan_chain_internal.hpp"

namespace mjarm::episode {

Pose jaws_pose(const Jaws& jaws) {
  Pose X_TJ{.p = jaws.center_T};
  X_TJ.R.col(0) = -jaws.side_T();  // close x approach
  X_TJ.R.col(1) = jaws.close_T;
  X_TJ.R.col(2) = jaws.approach_T;
  return X_TJ;
}

program::Instruction plan_to(const Pose& X_WT) {
  return {program::PlanMove{.goal = program::ProgramPose{.X_FT = X_WT}}};
}

program::Instruction line_to(const Pose& X_WT, double speed) {
  return program::move_l(X_WT, speed);
}

program::Instruction grip(bool close) { return {program::Grip{.close = close}}; }

PlanChain::PlanChain(const PlanInput& input, std::span<const double> q)
    : input_(&input), q_(q.begin(), q.end()), scene_(input.before) {}

bool PlanChain::add(std::vector<program::Instruction> instructions, Allowed allowed) {
  if (!reason_.empty()) return false;
  program::Program program;
  program.start.values = q_;
  program.instructions = std::move(instructions);
  program::ProgramPlan piece =
      program::plan_program(input_->robot.model, input_->robot.arm, program,
                            {.scene = scene_,
                             .allowed = std::move(allowed),
                             .to_first_fault = true,
                             .stop = input_->stop});
  if (!piece.ok()) {
    reason_ = piece.faults.front().reason;
    return false;
  }
  append(std::move(piece));
  return true;
}

void PlanChain::append(program::ProgramPlan piece) {
  const JointVec q = piece.q_end();
  q_.assign(q.data(), q.data() + q.size());
  scene_ = std::move(piece.scene_end);
  if (plan_.moves.empty()) {
    plan_ = std::move(piece);
  } else {
    std::ranges::move(piece.moves, std::back_inserter(plan_.moves));
  }
}

void PlanChain::append(PlanChain piece, const ToolPress& press) {
  if (!piece.reason_.empty()) return refuse(std::move(piece.reason_));
  for (PlannedMove& move : piece.plan_.moves) {
    if (move.curve) move.press = press;
  }
  append(std::move(piece.plan_));
}

TaskPlan PlanChain::finish(const Pose& goal) && {
  if (!reason_.empty()) return {.plan = {}, .goal = goal, .reason = std::move(reason_)};
  plan_.scene_end = std::move(scene_);
  return {.plan = std::move(plan_), .goal = goal, .reason = {}};
}

}  // namespace mjarm::episode
