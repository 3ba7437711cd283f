#include "mjarm/sim/stepper.hpp"

#include <algorithm>
#include <utility>

#include "mjarm/sim/ghost_internal.hpp"

namespace mjarm {

void FollowOutcome::add(const FollowOutcome& next) {
  reached += next.reached;
  steps += next.steps;
  duration += next.duration;
  stopped = next.stopped;
  worst_error = std::max(worst_error, next.worst_error);
  final_error = next.final_error;
  final_tool_error = next.final_tool_error;
  velocity_use = std::max(velocity_use, next.velocity_use);
  torque_use = std::max(torque_use, next.torque_use);
  limited_steps += next.limited_steps;
  if (!first_contact) first_contact = next.first_contact;
}

Stepper::Stepper(const Sim& sim, const Arm& arm)
    : arm_(&arm), ctrl_(sim.ctrl().size()), q_ref_(sim.arm_state(arm).q), start_(sim.time()) {}

Result<void> Stepper::step(Sim& sim, Controller& controller, const StepReference& reference,
                           Recorder* recorder) {
  if (outcome_.steps == 0 && recorder != nullptr) recorder->record(sim, reference.now);
  std::ranges::copy(sim.ctrl(), ctrl_.begin());
  limited_ = controller.command(sim.qpos(), sim.qvel(), reference, ctrl_);
  if (auto stepped = sim.step(ctrl_); !stepped) {
    broken_ = true;
    return stepped;
  }
  q_ref_ = reference.next;
  measure(sim);
  if (recorder != nullptr) recorder->record(sim, reference.next);
  return {};
}

void Stepper::measure(const Sim& sim) {
  const JointLimits& limits = arm_->limits;
  const JointState state = sim.arm_state(*arm_);
  ++outcome_.steps;
  outcome_.duration = sim.time() - start_;
  outcome_.limited_steps += limited_ ? 1 : 0;
  outcome_.worst_error = std::max(outcome_.worst_error, (q_ref_ - state.q).cwiseAbs().maxCoeff());
  outcome_.velocity_use =
      std::max(outcome_.velocity_use, state.v.cwiseAbs().cwiseQuotient(limits.velocity).maxCoeff());
  const JointVec torque = sim.arm_torque(*arm_);
  outcome_.torque_use =
      std::max(outcome_.torque_use, torque.cwiseAbs().cwiseQuotient(limits.torque).maxCoeff());
  if (!outcome_.first_contact) {
    const auto contacts = sim.contacts(*arm_);
    if (!contacts.empty()) outcome_.first_contact = TimedContact{contacts.front(), sim.time()};
  }
}

JointVec Stepper::error(const Sim& sim) const { return q_ref_ - sim.arm_state(*arm_).q; }

FollowOutcome Stepper::outcome(const Sim& sim) const {
  FollowOutcome outcome = outcome_;
  // After a breakdown the world stands in its initial state, which says nothing about the run.
  if (broken_) return outcome;
  outcome.final_error = error(sim).cwiseAbs().maxCoeff();
  Ghost ghost(sim.model(), *arm_);
  outcome.final_tool_error = (ghost.tool(sim, q_ref_).p - sim.tool(*arm_).p).norm();
  return outcome;
}

}  // namespace mjarm
