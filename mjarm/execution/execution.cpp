#include "mjarm/execution/execution.hpp"

#include <algorithm>
#include <utility>

#include "mjarm/core/messages/execution.hpp"
#include "mjarm/model/gripper_command.hpp"
#include "mjarm/model/object_shape.hpp"

namespace mjarm {

Execution::Execution(const Model& model, const MotionPlan& plan, Controller controller,
                     const ExecutionOptions& options)
    : plan_(&plan),
      model_(model),
      options_(options),
      controller_(std::move(controller)),
      clock_(plan, model.timestep(), options.rest),
      watch_(model, plan) {}

Result<Execution> Execution::create(const Model& model, const MotionPlan& plan,
                                    const ExecutionOptions& options) {
  const Arm& arm = plan.arms.front();
  for (const PlannedMove& move : plan.moves) {
    const int dof = move.trajectory.dof();
    if (dof != arm.dof()) {
      return fail(Errc::usage, text(msg::execution_other_arm, dof, arm.name, arm.dof()));
    }
    if (move.close && !arm.gripper) {
      return fail(Errc::not_available, text(msg::execution_no_gripper));
    }
  }
  Result<std::optional<Presser>> presser = Presser::create(model, plan, options.control);
  if (!presser) return fail(std::move(presser.error()));
  ControlOptions stiffness;
  if (*presser) stiffness.impedance = Presser::kImpedance;
  Result<Controller> controller = Controller::create(model, arm, options.control, stiffness);
  if (!controller) return fail(std::move(controller.error()));
  Execution execution(model, plan, std::move(*controller), options);
  execution.presser_ = std::move(*presser);
  execution.control_ = stiffness;
  if (options.contact == ContactReaction::stop) {
    Result<ContactGuard> guard = ContactGuard::create(model, arm);
    if (!guard) return fail(std::move(guard.error()));
    execution.guard_ = std::move(*guard);
  }
  return execution;
}

void Execution::restart() {
  controller_.restart();
  controller().set_axial(std::nullopt, 0);
  clock_.restart();
  stepper_.reset();
  if (presser_) presser_->restart();
  motions_.clear();
  watch_.restart();
  grip_.reset();
  gripped_.reset();
  if (guard_) guard_->restart();
}

void Execution::begin_motion(Sim& sim, std::size_t move, double from) {
  stepper_.emplace(sim, plan_->arms.front());
  motions_.push_back({.move = move, .from = from, .to = from, .outcome = {}});
}

/// Notes down how the current motion went so far.
void Execution::take_measures(const Sim& sim) {
  if (motions_.empty()) return;
  const std::size_t reached = motions_.back().outcome.reached;
  motions_.back().to = sim.time();
  motions_.back().outcome = stepper_->outcome(sim);
  motions_.back().outcome.reached = reached;
  const std::optional<TimedContact>& contact = watch_.first_contact();
  const bool here = contact && contact->time >= motions_.back().from;
  motions_.back().outcome.first_contact = here ? contact : std::nullopt;
}

void Execution::end_motion(const Sim& sim) {
  motions_.back().outcome.reached = 1;
  take_measures(sim);
}

MotionClock::Step Execution::next(Sim& sim) {
  const bool begun = !motions_.empty();
  if (presser_ && begun && presser_->look(sim, controller(), clock_)) {
    return {.reference = hold(as_span(clock_.q_ref())),
            .motion = clock_.motion(),
            .moves = true,
            .waits = true};
  }
  if (reacts() && state() != State::stopping) {
    if (const auto back = guard_->back_off(*plan_, clock_)) {
      return {.reference = *back, .motion = clock_.motion(), .moves = true, .waits = true};
    }
  }
  MotionClock::Step step = clock_.next();
  if (step.close) {
    gripped_ = step.motion;
    const Gripper& gripper = *plan_->arms.front().gripper;
    const PlannedMove* move =
        step.motion < plan_->moves.size() ? &plan_->moves[step.motion] : nullptr;
    // One that takes no time is passed already.
    const double seconds = move != nullptr && move->close ? move->trajectory.duration() : 0;
    grip_.emplace();
    grip_->steps = static_cast<int>(kGripShare * seconds / sim.model().timestep());
    grip_->grip = *step.close ? 1 : 0;
    for (const GripperDrive& drive : gripper.drives) {
      grip_->from.push_back(sim.ctrl()[static_cast<std::size_t>(drive.id)]);
    }
  }
  if (grip_) move_gripper(sim);
  return step;
}

void Execution::take_load(Sim& sim, std::size_t move) {
  const Arm& arm = plan_->arms.front();
  double load = 0;
  if (move > 0) {
    const SceneBodies bodies = scene_bodies(model_, arm);
    for (const AttachedBody& one : plan_->moves[move - 1].attached) {
      const auto object = std::ranges::find(bodies.objects, one.body, &SceneObject::name);
      if (object != bodies.objects.end()) load += object_mass(model_, object->body).mass;
    }
  }
  const Payload& payload = plan_->moves[move].payload;
  if (load == load_ && payload == payload_) return;
  if (loaded_) controller_.learn_from(*loaded_);
  loaded_.reset();
  // A payload is checked where the plan is made.
  const Model hung = with_payload(model_, arm.tip, payload).value_or(model_);
  if (payload != payload_) sim.take_masses(hung);
  load_ = load;
  payload_ = payload;
  if (load == 0 && payload.mass == 0) {
    if (guard_) guard_->change_model(model_);
    return;
  }
  const Result<Model> heavier = with_payload(hung, arm.tip, {.mass = load});
  if (!heavier) return;
  if (guard_) guard_->change_model(*heavier);
  if (auto made = Controller::create(*heavier, arm, options_.control, control_)) {
    loaded_ = std::move(*made);
    loaded_->learn_from(controller_);
  }
}

void Execution::move_gripper(Sim& sim) {
  const double share = grip_->done < grip_->steps ? (grip_->done + 1.0) / grip_->steps : 1.0;
  const std::vector<GripperDrive>& drives = plan_->arms.front().gripper->drives;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const double from = grip_->from[i], to = ctrl_for_grip(drives[i], grip_->grip);
    sim.set_ctrl(drives[i].id, share == 1 ? to : from + share * (to - from));
  }
  ++grip_->done;
  if (share == 1) grip_.reset();
}

/// A contact that is noticed brakes the arm from the step after this one on.
void Execution::feel(const Sim& sim, std::size_t motion) {
  const bool by_gripper = gripped_ && motion <= *gripped_ + 1;
  if (guard_->look(sim, by_gripper || presser_)) clock_.brake(plan_->arms.front().limits);
}

Result<void> Execution::step(Sim& sim) { return make_step(sim, next(sim)); }

Result<void> Execution::make_step(Sim& sim, const MotionClock::Step& step) {
  // A motion that is passed ends within the step, and the controller goes on as it is.
  const double passed = step.passes ? sim.model().timestep() - clock_.time() : 0;
  if (step.passes) {
    end_motion(sim);
  } else if (step.begins) {
    controller_.restart();
    if (loaded_) loaded_->restart();
  }
  if (step.begins) {
    take_load(sim, step.motion);
    begin_motion(sim, step.motion, sim.time() + passed);
  }
  if (!stepper_) stepper_.emplace(sim, plan_->arms.front());
  if (step.begins && motions_.size() == 1) watch_.look(sim, step.motion);
  if (guard_) feel(sim, step.motion);
  if (auto stepped = stepper_->step(sim, controller(), step.reference, options_.recorder);
      !stepped) {
    return stepped;
  }
  if (guard_) guard_->take(controller().torque());
  watch_.look(sim, step.motion, presser_ && presser_->is_down());
  if (step.waits) take_measures(sim);
  if (step.ends) {
    const std::size_t all = plan_->moves.size();
    if (step.motion + 1 == all) watch_.look(sim, all);
    end_motion(sim);
  }
  return {};
}

Result<FollowOutcome> Execution::run_to_end(Sim& sim, const AfterStep& after_step) {
  run();
  while (state() == State::running || reacts()) {
    const MotionClock::Step step = next(sim);
    if (!step.moves) break;  // what was left takes no time
    if (auto stepped = make_step(sim, step); !stepped) return fail(std::move(stepped.error()));
    if (!after_step || after_step(sim)) continue;
    take_measures(sim);
    motions_.back().outcome.stopped = true;
    break;
  }
  return outcome();
}

JointVec Execution::error(const Sim& sim) const {
  if (!stepper_) return JointVec::Zero(plan_->arms.front().dof());
  return stepper_->error(sim);
}

MotionPart Execution::part() const {
  if (presser_) return presser_->writes() ? MotionPart::work : MotionPart::approach;
  return motions_.empty() ? MotionPart::approach : plan_->part(motions_.back().move);
}

FollowOutcome Execution::outcome() const {
  FollowOutcome all;
  for (const ExecutedMotion& motion : motions_) all.add(motion.outcome);
  return all;
}

}  // namespace mjarm
