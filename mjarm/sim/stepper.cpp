#include <algorithm>
#include <cmath>

#include "mjarm/sim/ghost_internal.hpp"
#include "mjarm/sim/stepper_internal.hpp"

namespace mjarm {

Stepper::Stepper(const FollowSetup& setup)
    : setup_(setup),
      ctrl_(setup.sim.ctrl().begin(), setup.sim.ctrl().end()),
      q_ref_(setup.sim.arm_state(setup.arm).q),
      start_(setup.sim.time()) {}

Result<bool> Stepper::step(const StepReference& reference) {
  Sim& sim = setup_.sim;
  if (outcome_.steps == 0 && setup_.recorder != nullptr) {
    setup_.recorder->record(sim, reference.now);
  }
  limited_ = setup_.controller.command(sim.qpos(), sim.qvel(), reference, ctrl_);
  if (auto stepped = sim.step(ctrl_); !stepped) {
    broken_ = true;
    return fail(std::move(stepped.error()));
  }
  q_ref_ = reference.next;
  measure(reference.next);
  if (setup_.recorder != nullptr) setup_.recorder->record(sim, reference.next);
  if (setup_.after_step && !setup_.after_step(sim, reference.next)) outcome_.stopped = true;
  return !outcome_.stopped;
}

void Stepper::measure(const JointVec& q_ref) {
  const Sim& sim = setup_.sim;
  const JointLimits& limits = setup_.arm.limits;
  const JointState state = sim.arm_state(setup_.arm);
  ++outcome_.steps;
  outcome_.duration = sim.time() - start_;
  outcome_.limited_steps += limited_ ? 1 : 0;
  outcome_.worst_error = std::max(outcome_.worst_error, (q_ref - state.q).cwiseAbs().maxCoeff());
  outcome_.velocity_use =
      std::max(outcome_.velocity_use, state.v.cwiseAbs().cwiseQuotient(limits.velocity).maxCoeff());
  const JointVec torque = sim.arm_torque(setup_.arm);
  outcome_.torque_use =
      std::max(outcome_.torque_use, torque.cwiseAbs().cwiseQuotient(limits.torque).maxCoeff());
  if (!outcome_.first_contact) {
    const auto contacts = sim.contacts(setup_.arm);
    if (!contacts.empty()) outcome_.first_contact = TimedContact{contacts.front(), sim.time()};
  }
}

JointVec Stepper::error() const { return q_ref_ - setup_.sim.arm_state(setup_.arm).q; }

FollowOutcome Stepper::outcome() const {
  FollowOutcome outcome = outcome_;
  // After a breakdown the world stands in its initial state, which says nothing about the run.
  if (broken_) return outcome;
  outcome.final_error = error().cwiseAbs().maxCoeff();
  Ghost ghost(setup_.sim.model(), setup_.arm);
  outcome.final_tool_error =
      (ghost.tool(setup_.sim, q_ref_).p - setup_.sim.tool(setup_.arm).p).norm();
  return outcome;
}

}  // namespace mjarm
