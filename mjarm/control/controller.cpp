#include "mjarm/control/controller.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

#include "mjarm/control/actuation.hpp"
#include "mjarm/control/step_inverse.hpp"
#include "mjarm/core/messages/control.hpp"
#include "mjarm/core/nearest_word.hpp"

namespace mjarm {
namespace {

constexpr std::array kModes = {ControlMode::servo, ControlMode::servo_gravity,
                               ControlMode::computed_torque};

Result<void> check_joint(const Arm& arm, const ArmJoint& joint, ControlMode mode) {
  if (!joint.actuator) {
    return fail(Errc::impossible, text(msg::control_no_actuator, arm.name, joint.name, joint.name));
  }
  const ArmActuator& actuator = *joint.actuator;
  if (actuator.gain == 0 || actuator.gear == 0) {
    return fail(Errc::impossible, text(msg::control_no_gain, arm.name, actuator.name, joint.name));
  }
  if (mode != ControlMode::computed_torque && !(servo_stiffness(actuator) > 0)) {
    return fail(Errc::impossible,
                text(msg::control_no_servo, arm.name, actuator.name, joint.name, name(mode)));
  }
  return {};
}

/// The discrete loop e_v+ = e_v - h (Kd e_v + Kp e), e+ = e + h e_v+ has its poles inside the unit
/// circle exactly then (Jury's criterion on z^2 - (2 - h Kd - h^2 Kp) z + 1 - h Kd).
Result<void> check_feedback(const ControlOptions& options, double h) {
  const bool stable = options.stiffness > 0 && options.damping > 0 &&
                      2 * h * options.damping + h * h * options.stiffness < 4;
  if (stable) return {};
  return fail(Errc::bad_input,
              text(msg::control_bad_feedback, options.stiffness, options.damping, h));
}

}  // namespace

std::string_view name(ControlMode mode) noexcept {
  switch (mode) {
    case ControlMode::servo:
      return "servo";
    case ControlMode::servo_gravity:
      return "servo_gravity";
    case ControlMode::computed_torque:
      return "computed_torque";
  }
  return "";
}

Result<ControlMode> control_mode(std::string_view word) {
  std::vector<std::string> words;
  for (const ControlMode mode : kModes) {
    if (name(mode) == word) return mode;
    words.emplace_back(name(mode));
  }
  return fail(Errc::usage, text(msg::control_unknown_mode, word) + did_you_mean(word, words));
}

struct Controller::Impl {
  Arm arm;
  ControlMode mode;
  ControlOptions options;
  StepInverse inverse;

  JointVec desired_acceleration(std::span<const double> qpos, std::span<const double> qvel,
                                const StepReference& reference) const {
    const double h = inverse.timestep();
    JointVec q(arm.dof());
    JointVec v(arm.dof());
    for (int i = 0; i < arm.dof(); ++i) {
      q[i] = qpos[arm.joints[i].qpos];
      v[i] = qvel[arm.joints[i].dof];
    }
    return reference.acceleration(h) + options.damping * (reference.velocity(h) - v) +
           options.stiffness * (reference.now - q);
  }
};

Controller::Controller(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Controller::~Controller() = default;
Controller::Controller(Controller&&) noexcept = default;
Controller& Controller::operator=(Controller&&) noexcept = default;

Result<Controller> Controller::make(const Model& model, const Arm& arm, ControlMode mode,
                                    const ControlOptions& options) {
  for (const ArmJoint& joint : arm.joints) {
    if (const auto usable = check_joint(arm, joint, mode); !usable) return fail(usable.error());
  }
  if (mode == ControlMode::computed_torque) {
    const auto usable = check_feedback(options, model.timestep());
    if (!usable) return fail(usable.error());
  }
  return Controller(std::unique_ptr<Impl>(new Impl{arm, mode, options, StepInverse(model, arm)}));
}

ControlMode Controller::mode() const noexcept { return impl_->mode; }

bool Controller::command(std::span<const double> qpos, std::span<const double> qvel,
                         const StepReference& reference, std::span<double> ctrl) {
  const Arm& arm = impl_->arm;
  assert(reference.next.size() == arm.dof());
  JointVec torque = JointVec::Zero(arm.dof());
  if (impl_->mode == ControlMode::computed_torque) {
    torque = impl_->inverse.torque(qpos, qvel, impl_->desired_acceleration(qpos, qvel, reference));
  } else if (impl_->mode == ControlMode::servo_gravity) {
    torque = impl_->inverse.holding_torque(qpos);
  }

  bool limited = false;
  for (int i = 0; i < arm.dof(); ++i) {
    const ArmActuator& actuator = *arm.joints[i].actuator;
    const double q = qpos[arm.joints[i].qpos];
    const double v = qvel[arm.joints[i].dof];
    const bool servo = impl_->mode != ControlMode::computed_torque;
    // A servo is asked for the torque at its goal and at rest; its own gains do the rest.
    const double wanted = servo ? ctrl_for_torque(actuator, torque[i], reference.next[i], 0)
                                : ctrl_for_torque(actuator, torque[i], q, v);
    const double given = std::clamp(wanted, actuator.ctrl_lower, actuator.ctrl_upper);
    // The force is left to the simulation to cut, as a drive would: cut here, it would sit on its
    // limit up to rounding, and the integrator would count it as cut in one step and not in the
    // next.
    const double force = actuator_force(actuator, given, q, v);
    limited =
        limited || given != wanted || force < actuator.force_lower || force > actuator.force_upper;
    ctrl[actuator.id] = given;
  }
  return limited;
}

}  // namespace mjarm
