// Control in a loop of the caller's own.
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>

#include <cmath>
#include <optional>
#include <utility>

#include "mjarm/control/controller.hpp"
#include "mjarm/core/finite.hpp"
#include "mjarm/execution/motion_plan.hpp"
#include "mjarm/model/joint_values.hpp"
#include "python/src/bindings.hpp"
#include "python/src/convert.hpp"
#include "python/src/robot.hpp"

namespace mjarm::python {
namespace {

/// An array of a MjData.
template <class T>
View<T> view_of(nb::handle data, const char* name, int size) {
  std::optional<View<T>> out;
  if (nb::hasattr(data, name)) out = View<T>::of(data.attr(name));
  if (!out || out->ndim() != 1) refuse(msg::python_no_data, name);
  if (out->size() != static_cast<std::size_t>(size)) {
    refuse(msg::python_other_model, name, out->size(), size);
  }
  return std::move(*out);
}

/// `mjarm.Controller`: a controller, and what the arm is to do.
class BoundController {
 public:
  BoundController(const BoundRobot& robot, Controller controller)
      : robot_(robot.robot), controller_(std::move(controller)) {}

  [[nodiscard]] std::string mode() const { return std::string(name(controller_.mode())); }
  [[nodiscard]] JointVec friction() const { return controller_.friction(); }

  void hold(nb::handle q) {
    const JointVec values = joint_vec(reals(q, "q", {robot_.arm.dof()}).span());
    value_of(check_joint_units(as_span(values), robot_.arm));
    rest_ = values;
    motion_.reset();
    controller_.restart();
  }

  void follow(const PlannedMove& move) {
    if (move.trajectory.dof() != robot_.arm.dof()) {
      refuse(msg::python_other_arm, move.trajectory.dof(), robot_.arm.dof());
    }
    motion_ = move.trajectory;
    begin_.reset();
    controller_.restart();
  }

  /// Writes the command of the step that comes.
  bool step(nb::handle data) {
    const Model& model = robot_.model;
    const auto qpos = view_of<const double>(data, "qpos", model.nq());
    const auto qvel = view_of<const double>(data, "qvel", model.nv());
    const auto ctrl = view_of<double>(data, "ctrl", model.nu());
    double time = 0;
    if (!nb::hasattr(data, "time") || !nb::try_cast(data.attr("time"), time) ||
        !std::isfinite(time)) {
      refuse(msg::python_no_data, "time");
    }
    const std::span<const double> q = qpos.span();
    if (!all_finite(q) || !all_finite(qvel.span())) refuse(msg::python_not_finite_state);
    const StepReference reference = next(q, time);
    return controller_.command(q, qvel.span(), reference, ctrl.span());
  }

  /// Whether the motion is at its end.
  [[nodiscard]] bool done() const {
    return !motion_ || (begin_ && now_ - *begin_ >= motion_->duration());
  }

  /// Where the arm should be at the end of the step just commanded.
  [[nodiscard]] JointVec reference() const { return reference_; }

 private:
  StepReference next(std::span<const double> qpos, double time) {
    const double step = robot_.model.timestep();
    // The clock of a world that was put back begins anew, and so does its motion.
    if (!begin_ || time < *begin_) begin_ = time;
    now_ = time + step;
    if (!motion_ && rest_.size() == 0) rest_ = joints_in(qpos, robot_.arm);
    const StepReference out =
        motion_ ? reference_at(*motion_, time - *begin_, step) : mjarm::hold(as_span(rest_));
    reference_ = out.next;
    return out;
  }

  Robot robot_;
  Controller controller_;
  JointVec rest_ = {};
  std::optional<Trajectory> motion_ = {};
  std::optional<double> begin_ = {};
  double now_ = 0;
  JointVec reference_ = {};
};

std::unique_ptr<BoundController> controller(const BoundRobot& robot, const std::string& control,
                                            double stiffness, double damping, double integral,
                                            int late_steps) {
  const ControlMode mode = value_of(control_mode(control));
  const ControlOptions options{.stiffness = stiffness,
                               .damping = damping,
                               .integral = integral,
                               .robust = {.late_steps = late_steps}};
  return std::make_unique<BoundController>(
      robot, value_of(Controller::create(robot.robot.model, robot.arm(), mode, options)));
}

constexpr const char* kController = R"(Control in a simulation loop of your own.

    controller = robot.controller()
    controller.follow(motion)                 # or hold(q)
    while not controller.done:
        controller.step(data)                 # writes data.ctrl
        mujoco.mj_step(model, data)

Parameters
----------
control : str, optional
    As simulate() has it.
stiffness, damping, integral : float, optional
    Feedback of computed torque: acceleration per error [1/s^2], [1/s], [1/s^3].
late_steps : int, optional
    Time steps from a command to when it acts, 0 to 20; "robust" reckons with it.
)";

}  // namespace

void bind_control(nb::module_& m) {
  const ControlOptions usual;
  nb::class_<BoundController>(
      m, "Controller", "Turns the state of a simulation into commands; made by Robot.controller().")
      .def_prop_ro("control", &BoundController::mode, "How it makes the arm follow.")
      .def("hold", &BoundController::hold, nb::arg("q"),
           nb::sig("def hold(self, q: ArrayLike) -> None"),
           "From now on the arm shall stand at `q` [rad or m], shape (dof,).")
      .def("follow", &BoundController::follow, nb::arg("motion"),
           nb::sig("def follow(self, motion: Motion) -> None"),
           "Follows a motion, which begins with the next step; at its end the arm is held. It "
           "should stand at its beginning.")
      .def("step", &BoundController::step, nb::arg("data").none(),
           nb::sig("def step(self, data: Any) -> bool"),
           "Writes the arm's part of `data.ctrl` for the step that comes, from qpos, qvel and time "
           "of "
           "a mujoco.MjData;\n"
           "nothing is copied, nothing else is changed. True where a limit cuts the command. Until "
           "it is "
           "told something, it\n"
           "holds the arm where it stands.")
      .def_prop_ro(
          "friction", [](const BoundController& c) { return array(c.friction()); },
          nb::sig("def friction(self) -> Array"),
          "Dry friction of the joints as \"robust\" has learned it [N m or N], (dof,); else zeros.")
      .def_prop_ro("done", &BoundController::done, "Whether the motion is at its end.")
      .def_prop_ro(
          "reference", [](const BoundController& c) { return array(c.reference()); },
          nb::sig("def reference(self) -> Array"),
          "Where the arm should be at the end of the step just commanded [rad or m], (dof,).");
  auto robot = nb::borrow<nb::class_<BoundRobot>>(m.attr("Robot"));
  robot.def("controller", &controller, nb::arg("control") = "computed_torque", nb::kw_only(),
            nb::arg("stiffness") = usual.stiffness, nb::arg("damping") = usual.damping,
            nb::arg("integral") = usual.integral, nb::arg("late_steps") = usual.robust.late_steps,
            nb::sig("def controller(self, control: str = 'computed_torque', *, stiffness: float = "
                    "900.0, damping: float = 60.0, integral: float = 0.0, late_steps: int = 0) -> "
                    "Controller"),
            kController);
}

}  // namespace mjarm::python
