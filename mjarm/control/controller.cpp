#include "mjarm/control/controller.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "mjarm/control/actuation.hpp"
#include "mjarm/control/step_inverse.hpp"
#include "mjarm/core/messages/control.hpp"
#include "mjarm/core/nearest_word.hpp"

namespace mjarm {
namespace {

constexpr std::array<std::string_view, 7> kNames = {
    "servo",           "servo_gravity",  "feed_forward", "computed_torque",
    "joint_impedance", "tool_impedance", "robust"};

/// True where the position gains of the actuators do the feedback.
bool by_servos(ControlMode mode) {
  return mode == ControlMode::servo || mode == ControlMode::servo_gravity ||
         mode == ControlMode::feed_forward;
}

Result<void> check_joint(const Arm& arm, const ArmJoint& joint, ControlMode mode) {
  if (!joint.actuator) {
    return fail(Errc::impossible, text(msg::control_no_actuator, arm.name, joint.name, joint.name));
  }
  const ArmActuator& actuator = *joint.actuator;
  if (actuator.gain == 0 || actuator.gear == 0) {
    return fail(Errc::impossible, text(msg::control_no_gain, arm.name, actuator.name, joint.name));
  }
  if (by_servos(mode) && !(servo_stiffness(actuator) > 0)) {
    return fail(Errc::impossible,
                text(msg::control_no_servo, arm.name, actuator.name, joint.name, name(mode)));
  }
  return {};
}

/// The loop e_v+ = e_v - h (Kd e_v + Kp e + Ki s), e+ = e + h e_v+, s+ = s + h e has its poles
/// inside the unit circle exactly where Jury's criterion holds for
/// z^3 + (a + b - 3) z^2 + (3 - 2 a - b + c) z + a - 1 with a = h Kd, b = h^2 Kp, c = h^3 Ki;
/// without Ki for z^2 + (a + b - 2) z + 1 - a.
bool is_stable(const ControlOptions& options, double h) {
  const double a = h * options.damping, b = h * h * options.stiffness,
               c = h * h * h * options.integral;
  if (!(a > 0 && b > 0 && c >= 0)) return false;
  if (c == 0) return 2 * a + b < 4;
  const double z2 = a + b - 3, z1 = 3 - 2 * a - b + c, z0 = a - 1;
  return 8 - 4 * a - 2 * b + c > 0 && std::abs(z0) < 1 && 1 - z0 * z0 > std::abs(z0 * z2 - z1);
}

Result<void> check_feedback(const ControlOptions& options, double h) {
  if (is_stable(options, h)) return {};
  return fail(Errc::bad_input, text(msg::control_bad_feedback, options.stiffness, options.damping,
                                    options.integral, h));
}

Result<void> check_impedance(const Impedance& impedance) {
  const std::pair<const char*, double> springs[] = {
      {"joint_stiffness", impedance.joint_stiffness},
      {"tool_stiffness", impedance.tool_stiffness},
      {"tool_turn_stiffness", impedance.tool_turn_stiffness}};
  for (const auto& [what, value] : springs) {
    if (!(value > 0 && std::isfinite(value))) {
      return fail(Errc::bad_input, text(msg::control_bad_spring, what, value));
    }
  }
  const std::pair<const char*, double> others[] = {
      {"posture_stiffness", impedance.posture_stiffness},
      {"damping_ratio", impedance.damping_ratio}};
  for (const auto& [what, value] : others) {
    if (!(value >= 0 && std::isfinite(value))) {
      return fail(Errc::bad_input, text(msg::control_bad_spring, what, value));
    }
  }
  return {};
}

Result<void> check_options(const ControlOptions& options, ControlMode mode, double h) {
  if (mode == ControlMode::robust) return {};  // RobustLoop looks at its own
  if (mode == ControlMode::computed_torque) return check_feedback(options, h);
  return check_impedance(options.impedance);
}

/// The torque that the actuators shall give were the joints at `q`, moving at `v`, all (dof,).
struct Demand {
  JointVec torque, q, v;
};

}  // namespace

std::span<const std::string_view> control_mode_names() noexcept { return kNames; }

std::string_view name(ControlMode mode) noexcept { return kNames[static_cast<std::size_t>(mode)]; }

Result<ControlMode> control_mode(std::string_view word) {
  const auto index = index_of_word(word, kNames, msg::control_unknown_mode);
  if (!index) return fail(index.error());
  return static_cast<ControlMode>(*index);
}

struct Controller::Impl {
  Arm arm;
  ControlMode mode;
  ControlOptions options;
  StepInverse inverse;
  LinkChain links;
  JointVec sum;     // [rad s or m s] of the errors
  JointVec torque;  // of the last command
  std::optional<AxialPush> push = {};
  double axial_offset = 0;
  std::optional<RobustLoop> robust = {};  // of its mode

  using State = std::span<const double>;

  Demand demand(State qpos, State qvel, const StepReference& reference) {
    const JointVec zero = JointVec::Zero(arm.dof());
    switch (mode) {
      case ControlMode::servo:
        return {zero, reference.next, zero};
      case ControlMode::servo_gravity:
        // At the goal and at rest; the servo's own gains do the rest.
        return {inverse.holding_torque(qpos), reference.next, zero};
      case ControlMode::feed_forward:
        return on_reference(qpos, qvel, reference);
      default:
        break;
    }
    const double h = inverse.timestep();
    ImpedanceState x{
        JointVec(arm.dof()), JointVec(arm.dof()),    reference.now, reference.velocity(h), push,
        axial_offset,        inverse.implicit_mass()};
    for (int i = 0; i < arm.dof(); ++i) {
      x.q[i] = qpos[arm.joints[i].qpos];
      x.v[i] = qvel[arm.joints[i].dof];
    }
    if (mode == ControlMode::robust) return {robust->torque(qpos, qvel, reference), x.q, x.v};
    JointVec a = reference.acceleration(h);
    if (mode == ControlMode::computed_torque) {
      a += options.damping * (x.v_ref - x.v) + options.stiffness * (x.q_ref - x.q) +
           options.integral * sum;
      return {inverse.torque(qpos, qvel, a), x.q, x.v};
    }
    const Eigen::MatrixXd mass = inverse.mass_matrix(qpos);
    const JointVec spring = mode == ControlMode::joint_impedance
                                ? joint_spring(options.impedance, x, mass)
                                : tool_spring(options.impedance, x, mass, links);
    return {inverse.torque(qpos, qvel, a) + spring, x.q, x.v};
  }

  /// Adds the errors of this step to the sum.
  void gather(State qpos, const JointVec& q_ref) {
    for (int i = 0; i < arm.dof(); ++i) {
      sum[i] += inverse.timestep() * (q_ref[i] - qpos[arm.joints[i].qpos]);
    }
  }

  /// The torque of the reference itself: the servos see how far the arm is off it.
  Demand on_reference(State qpos, State qvel, const StepReference& reference) {
    const double h = inverse.timestep();
    const JointVec v = reference.velocity(h);
    std::vector<double> q_all(qpos.begin(), qpos.end()), v_all(qvel.begin(), qvel.end());
    for (int i = 0; i < arm.dof(); ++i) {
      q_all[static_cast<std::size_t>(arm.joints[i].qpos)] = reference.now[i];
      v_all[static_cast<std::size_t>(arm.joints[i].dof)] = v[i];
    }
    return {inverse.torque(q_all, v_all, reference.acceleration(h)), reference.now, v};
  }
};

Controller::Controller(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Controller::~Controller() = default;
Controller::Controller(Controller&&) noexcept = default;
Controller& Controller::operator=(Controller&&) noexcept = default;

Result<Controller> Controller::create(const Model& model, const Arm& arm, ControlMode mode,
                                      const ControlOptions& options) {
  for (const ArmJoint& joint : arm.joints) {
    if (const auto usable = check_joint(arm, joint, mode); !usable) return fail(usable.error());
  }
  const auto usable = check_options(options, mode, model.timestep());
  if (!usable) return fail(usable.error());
  std::unique_ptr<Impl> impl(new Impl{arm, mode, options, StepInverse(model, arm),
                                      LinkChain(Chain(arm)), JointVec::Zero(arm.dof()),
                                      JointVec::Zero(arm.dof())});
  if (mode == ControlMode::robust) {
    Result<RobustLoop> loop = RobustLoop::create(model, arm, options.robust);
    if (!loop) return fail(std::move(loop.error()));
    impl->robust = std::move(*loop);
  }
  return Controller(std::move(impl));
}

ControlMode Controller::mode() const noexcept { return impl_->mode; }

bool Controller::command(std::span<const double> qpos, std::span<const double> qvel,
                         const StepReference& reference, std::span<double> ctrl) {
  const Arm& arm = impl_->arm;
  assert(reference.next.size() == arm.dof());
  const Demand demand = impl_->demand(qpos, qvel, reference);
  bool limited = false;
  JointVec& torque = impl_->torque;
  for (int i = 0; i < arm.dof(); ++i) {
    const ArmActuator& actuator = *arm.joints[i].actuator;
    const double q = qpos[arm.joints[i].qpos];
    const double v = qvel[arm.joints[i].dof];
    const double wanted = ctrl_for_torque(actuator, demand.torque[i], demand.q[i], demand.v[i]);
    const double given = std::clamp(wanted, actuator.ctrl_lower, actuator.ctrl_upper);
    // The force is left to the simulation to cut, as a drive would: cut here, it would sit on its
    // limit up to rounding, and the integrator would count it as cut in one step and not in the
    // next.
    const double force = actuator_force(actuator, given, q, v);
    limited =
        limited || given != wanted || force < actuator.force_lower || force > actuator.force_upper;
    ctrl[actuator.id] = given;
    torque[i] = actuator.gear * std::clamp(force, actuator.force_lower, actuator.force_upper);
  }
  if (impl_->robust) impl_->robust->take(torque);
  // Behind a limit the error is no sign of a load, and a sum of it would overshoot.
  if (impl_->options.integral > 0 && !limited) impl_->gather(qpos, reference.now);
  return limited;
}

void Controller::set_axial(std::optional<AxialPush> push, double offset) {
  impl_->push = push;
  impl_->axial_offset = offset;
}

const JointVec& Controller::torque() const noexcept { return impl_->torque; }

void Controller::restart() { impl_->sum.setZero(); }

void Controller::learn_from(const Controller& other) {
  if (impl_->robust && other.impl_->robust) impl_->robust->learn_from(*other.impl_->robust);
}

JointVec Controller::friction() const {
  return impl_->robust ? impl_->robust->friction() : JointVec::Zero(impl_->arm.dof());
}

}  // namespace mjarm
