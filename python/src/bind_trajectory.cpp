// Motions: paths and plans in time.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <cmath>

#include "mjarm/execution/motion_plan.hpp"
#include "mjarm/execution/path_motion.hpp"
#include "mjarm/trajectory/path_timing.hpp"
#include "mjarm/trajectory/point_to_point.hpp"
#include "mjarm/trajectory/tool_motion.hpp"
#include "mjarm/trajectory/trajectory.hpp"
#include "mjarm/trajectory/via_points.hpp"
#include "python/src/bindings.hpp"
#include "python/src/convert.hpp"
#include "python/src/interrupt.hpp"
#include "python/src/outcomes.hpp"
#include "python/src/robot.hpp"

namespace mjarm::python {
namespace {

constexpr double kMostSamples = 1e8;

PlannedMove time_path_of_tool(const BoundRobot& robot, const BoundPath& path,
                              const TimingOptions& timing) {
  if (path.failure) raise(Error{Errc::impossible, path.what});
  if (!path.curve) refuse(msg::python_no_way);
  auto motion = interruptible([&](const StopCheck& stop) {
    return time_tool_motion(robot.ik, *path.curve, path.had,
                            {.path = {.stop = stop}, .timing = timing});
  });
  if (!motion) raise(Error{Errc::impossible, describe(motion.error(), robot.arm())});
  return {.word = "path",
          .trajectory = std::move(motion->trajectory),
          .curve = std::move(motion->curve),
          .dips = std::move(motion->dips)};
}

PlannedMove time_plan(const BoundPlan& plan, const JointLimits& limits) {
  PlanningWorld world = *plan.world;  // another thread may time the same plan
  auto motion = interruptible([&](const StopCheck& stop) -> Result<PathMotion> {
    const auto prover = world.prover({&plan.path, 1}, stop);
    if (!prover) return fail(prover.error());
    return time_path(plan.path.q, limits, *prover, {.stop = stop});
  });
  PathMotion timed = value_of(std::move(motion));
  return {.word = "plan",
          .trajectory = std::move(timed.trajectory),
          .corners = plan.path.q,
          .stopping = timed.stopping,
          .attached = plan.rules.attached};
}

/// Splines through waypoints know no ranges of joints: a motion that leaves one is refused.
void check_range(const BoundRobot& robot, const Trajectory& motion) {
  constexpr double kRounding = 1e-4;  // [rad or m] of waypoints that stand at a limit
  const LimitUse use = [&] {
    const nb::gil_scoped_release free;
    return check_limits(motion, robot.arm().limits);
  }();
  int joint = 0;
  const double beyond = use.position.maxCoeff(&joint);
  if (!(beyond > kRounding)) return;
  const ArmJoint& leaving = robot.arm().joints[static_cast<std::size_t>(joint)];
  const char* const unit = leaving.type == JointType::hinge ? "rad" : "m";
  raise(Error{Errc::impossible, text(msg::python_leaves_range, leaving.name, beyond, unit)});
}

PlannedMove time(const BoundRobot& robot, nb::handle what, double tool_speed, double share) {
  if (!(share > 0 && share <= 1)) refuse(msg::python_share, "share");
  if (!(tool_speed > 0)) refuse(msg::python_positive, "tool_speed");
  const TimingOptions timing{.tool_speed = tool_speed, .joint_share = share};
  if (nb::isinstance<BoundPath>(what)) {
    return time_path_of_tool(robot, nb::cast<const BoundPath&>(what), timing);
  }
  JointLimits limits = robot.arm().limits;
  limits.velocity *= share;
  limits.acceleration *= share;
  if (nb::isinstance<BoundPlan>(what)) return time_plan(nb::cast<const BoundPlan&>(what), limits);
  const std::vector<JointVec> rows = robot.waypoints(what, "motion");
  PlannedMove move{.word = "joints", .trajectory = value_of([&] {
                                       const nb::gil_scoped_release free;
                                       return time_waypoint_path(rows, limits);
                                     }())};
  check_range(robot, move.trajectory);
  return move;
}

/// A motion, and when each waypoint is met.
nb::tuple time_via(const BoundRobot& robot, nb::handle waypoints, double share) {
  if (!(share > 0 && share <= 1)) refuse(msg::python_share, "share");
  const std::vector<JointVec> rows = robot.waypoints(waypoints, "waypoints");
  ViaMotion motion = value_of(interruptible([&](const StopCheck& stop) {
    return time_via_points(rows, robot.arm().limits, {.joint_share = share, .stop = stop});
  }));
  check_range(robot, motion.trajectory);
  return nb::make_tuple(PlannedMove{.word = "via", .trajectory = std::move(motion.trajectory)},
                        array(std::move(motion.times), {rows.size()}));
}

JointState state_of(const BoundRobot& robot, nb::handle value, const char* name) {
  const auto dof = static_cast<long long>(robot.dof());
  if (nb::isinstance<nb::tuple>(value) && nb::len(value) == 3) {
    const auto part = [&](int i) { return joint_vec(reals(value[i], name, {dof}).span()); };
    return {part(0), part(1), part(2)};
  }
  return JointState::at_rest(robot.joints(value, name));
}

PlannedMove time_between(const BoundRobot& robot, nb::handle start, nb::handle end) {
  return {.word = "joints",
          .trajectory = value_of(point_to_point(state_of(robot, start, "start"),
                                                state_of(robot, end, "end"), robot.arm().limits))};
}

nb::dict use_of(const PlannedMove& move, const JointLimits& limits) {
  const LimitUse use = check_limits(move.trajectory, limits);
  nb::dict out;
  out["velocity"] = array(use.velocity);
  out["acceleration"] = array(use.acceleration);
  out["jerk"] = array(use.jerk);
  out["position"] = array(use.position);
  return out;
}

/// Columns t, q, v, a of the states at these times.
nb::tuple states(const Trajectory& motion, const std::vector<double>& times) {
  const auto dof = static_cast<std::size_t>(motion.dof());
  std::vector<double> q, v, a;
  for (std::size_t i = 0; i < times.size(); ++i) {
    constexpr std::size_t kBlock = 4096;  // between looks at Ctrl-C
    if (i % kBlock == 0 && PyErr_CheckSignals() != 0) throw nb::python_error();
    const JointState state = motion.at(times[i]);
    q.insert(q.end(), state.q.begin(), state.q.end());
    v.insert(v.end(), state.v.begin(), state.v.end());
    a.insert(a.end(), state.a.begin(), state.a.end());
  }
  const std::size_t n = times.size();
  return nb::make_tuple(array(times, {n}), array(std::move(q), {n, dof}),
                        array(std::move(v), {n, dof}), array(std::move(a), {n, dof}));
}

nb::tuple sample(const PlannedMove& move, double dt) {
  const Trajectory& motion = move.trajectory;
  if (!(dt > 0) || motion.duration() / dt > kMostSamples) {
    refuse(msg::python_dt);
  }
  std::vector<double> times;
  const auto whole = static_cast<std::size_t>(std::ceil(motion.duration() / dt - 1e-9));
  for (std::size_t i = 0; i < whole; ++i) times.push_back(static_cast<double>(i) * dt);
  times.push_back(motion.duration());
  return states(motion, times);
}

}  // namespace

void bind_trajectory(nb::module_& m) {
  nb::class_<PlannedMove>(m, "Motion",
                          "A motion in time; joints keep their limits at every moment.")
      .def_prop_ro(
          "duration", [](const PlannedMove& move) { return move.trajectory.duration(); }, "[s]")
      .def_prop_ro(
          "dof", [](const PlannedMove& move) { return move.trajectory.dof(); }, "Number of joints.")
      .def_ro("word", &PlannedMove::word,
              "What it is: \"path\", \"plan\", \"joints\", or the instruction of a program.")
      .def_prop_ro(
          "line", [](const PlannedMove& move) { return move.place.line; },
          "Of the instruction in its program; 0: of none.")
      .def_ro("closes", &PlannedMove::close,
              "True: the gripper closes while it lasts; False: it opens; None: neither.")
      .def_ro("curve", &PlannedMove::curve, "What the tool follows; None for joint moves.")
      .def_prop_ro(
          "dips",
          [](const PlannedMove& move) {
            nb::list out;
            for (const SpeedDip& dip : move.dips) {
              out.append(nb::make_tuple(dip.t_from, dip.t_to, dip.least));
            }
            return out;
          },
          nb::sig("def dips(self) -> list[tuple[float, float, float]]"),
          "Where the tool is slower than asked: (from [s], to [s], least speed [m/s]).")
      .def(
          "at",
          [](const PlannedMove& move, double t) {
            if (!std::isfinite(t)) refuse(msg::python_seconds);
            const JointState state = move.trajectory.at(t);
            return nb::make_tuple(array(state.q), array(state.v), array(state.a));
          },
          nb::arg("t"), nb::sig("def at(self, t: float) -> tuple[Array, Array, Array]"),
          "Positions [rad or m], velocities and accelerations at time `t` [s], each (dof,).")
      .def(
          "use",
          [](const PlannedMove& move, const JointLimits& limits) {
            if (limits.velocity.size() != move.trajectory.dof()) {
              refuse(msg::python_other_arm, move.trajectory.dof(), limits.velocity.size());
            }
            return use_of(move, limits);
          },
          nb::arg("limits"), nb::sig("def use(self, limits: JointLimits) -> dict[str, Array]"),
          "Worst use of each limit, by joint, as a share of it: velocity, acceleration, jerk, "
          "sampled "
          "every 1 ms; position: how\nfar beyond its range [rad or m].")
      .def("sample", &sample, nb::arg("dt"),
           nb::sig("def sample(self, dt: float) -> tuple[Array, Array, Array, Array]"),
           "Times [s], (n,), and positions, velocities, accelerations, (n, dof): every `dt` [s] "
           "and at the end.")
      .def("__repr__", [](const PlannedMove& move) {
        return "<mjarm.Motion: " + move.word + ", " + std::to_string(move.trajectory.duration()) +
               " s, " + std::to_string(move.trajectory.dof()) + " joints>";
      });
  auto robot = nb::borrow<nb::class_<BoundRobot>>(m.attr("Robot"));
  robot.def("time", &time, nb::arg("motion"), nb::kw_only(),
            nb::arg("tool_speed") = TimingOptions().tool_speed, nb::arg("share") = 1.0,
            nb::sig("def time(self, motion: Path | Plan | ArrayLike | Sequence[ArrayLike], *, "
                    "tool_speed: float = 0.25, "
                    "share: float = 1.0) -> "
                    "Motion"),
            "The fastest motion along what is given, from rest to rest, within the limits of "
            "velocity, acceleration and\n"
            "jerk.\n\n"
            "The path of a curve is walked at `tool_speed` [m/s] where the joints can; a plan as "
            "fast as it can be, beside\n"
            "its corners as far as that is proved free; rows of joint values (n, dof) [rad or m] "
            "along the spline through\n"
            "them, which must keep every joint in its range (else Impossible). `share` of the "
            "limits of velocity and acceleration is used.");
  robot.def(
      "time_between", &time_between, nb::arg("start"), nb::arg("end"),
      nb::sig(
          "def time_between(self, start: ArrayLike | tuple[ArrayLike, ArrayLike, ArrayLike], end: "
          "ArrayLike | tuple[ArrayLike, ArrayLike, ArrayLike]) -> Motion"),
      "The fastest motion of all joints together from one state to another: joint values at rest, "
      "or "
      "(q, v, a), each (dof,).");
  robot.def("time_via", &time_via, nb::arg("waypoints"), nb::kw_only(), nb::arg("share") = 1.0,
            nb::sig("def time_via(self, waypoints: ArrayLike, *, share: float = 1.0) -> "
                    "tuple[Motion, Array]"),
            "The fastest motion through rows of joint values (n, dof) [rad or m], which are passed "
            "without a stop; its shape\n"
            "between them is free, but must keep every joint in its range (else Impossible). Also "
            "when each is met [s], (n,).");
}

}  // namespace mjarm::python
