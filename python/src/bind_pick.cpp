// Objects that are picked up and put down.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <utility>

#include "mjarm/program/pick_place.hpp"
#include "python/src/bindings.hpp"
#include "python/src/convert.hpp"
#include "python/src/interrupt.hpp"
#include "python/src/robot.hpp"

namespace mjarm::python {
namespace {

using program::PickPlan;

[[noreturn]] void raise_no_pick(const program::PickFailure& failure) {
  nb::object exception = error_class("NoPick")(failure.what);
  exception.attr("reason") = std::string(name(failure.code));
  nb::list dropped;
  for (const program::DroppedGrasp& grasp : failure.dropped) dropped.append(grasp.what);
  exception.attr("dropped") = dropped;
  raise(exception);
}

PickPlan pick(const BoundRobot& robot, const std::string& object, nb::handle place, bool any_turn,
              nb::handle q, nb::handle qpos, double tool_speed, double approach, double lift) {
  program::PickTask task{.object = object};
  if (!place.is_none()) {
    task.place = program::PlaceGoal{.X_WB = pose_of(place, "place"), .any_turn = any_turn};
  }
  if (!(tool_speed > 0 && approach > 0 && lift > 0)) {
    refuse(msg::python_positive, "tool_speed, approach, lift");
  }
  const JointVec q_start = robot.joints_or_home(q.is_none() ? qpos : q, "q");
  const SceneState scene{.qpos = qpos_of(qpos, robot.robot.model)};
  program::PickOptions options{.approach = approach, .lift = lift, .tool_speed = tool_speed};
  auto plan = interruptible([&](const StopCheck& stop) {
    options.stop = stop;
    return plan_pick(robot.robot, scene, as_span(q_start), task, options);
  });
  if (!plan) raise_no_pick(plan.error());
  return std::move(*plan);
}

constexpr const char* kPick =
    R"(Plans to pick an object up, and to put it down where that is asked for.

Above it by the planner, straight to it, the fingers close, straight up, by the planner with the object in the hand,
straight down, open, straight away; every motion is proved to be free.

Parameters
----------
object : str
    A body with a free joint.
place : Pose, optional
    Where its body is to be in the world; without, it is only lifted.
any_turn : bool, optional
    There it may be turned about the vertical.
q : array_like, shape (dof,), optional
    Where the arm stands [rad or m]; default: as in `qpos`, else home.
qpos : array_like, shape (nq,), optional
    How all else stands, the object included; default: as at home.
tool_speed, approach, lift : float, optional
    On straight ways [m/s]; their length to the object, and up with it [m].

Raises
------
NoPick
    With `reason` and, grasp by grasp, what was `dropped` and why.
)";

}  // namespace

void bind_pick(nb::module_& m) {
  nb::class_<PickPlan>(m, "PickPlan", "How an object is picked up, before anything moves.")
      .def_prop_ro(
          "motions", [](const PickPlan& p) { return p.plan.moves; },
          "One after another; Robot.simulate() executes them.")
      .def_prop_ro(
          "duration", [](const PickPlan& p) { return p.plan.duration(); }, "Of all [s].")
      .def_prop_ro(
          "grasp", [](const PickPlan& p) { return p.grasp.X_BT; },
          "The tool in the frame of the object's body, before the fingers close.")
      .def_prop_ro(
          "width", [](const PickPlan& p) { return p.grasp.width; },
          "Of what comes between the fingers [m].")
      .def_ro("place", &PickPlan::X_WB_place,
              "Where the object will be; None where it is only lifted.")
      .def("__len__", [](const PickPlan& p) { return p.plan.moves.size(); })
      .def("__repr__", [](const PickPlan& p) {
        return "<mjarm.PickPlan: " + std::to_string(p.plan.moves.size()) + " motions, " +
               std::to_string(p.plan.duration()) + " s>";
      });
  auto robot = nb::borrow<nb::class_<BoundRobot>>(m.attr("Robot"));
  const program::PickOptions usual;
  robot.def(
      "pick", &pick, nb::arg("object"), nb::arg("place").none() = nb::none(), nb::kw_only(),
      nb::arg("any_turn") = false, nb::arg("q").none() = nb::none(),
      nb::arg("qpos").none() = nb::none(), nb::arg("tool_speed") = usual.tool_speed,
      nb::arg("approach") = usual.approach, nb::arg("lift") = usual.lift,
      nb::sig("def pick(self, object: str, place: PoseLike | None = None, *, any_turn: bool = "
              "False, q: "
              "ArrayLike | None = None, qpos: ArrayLike | None = None, tool_speed: float = 0.15, "
              "approach: float = 0.08, lift: float = 0.1) -> PickPlan"),
      kPick);
}

}  // namespace mjarm::python
