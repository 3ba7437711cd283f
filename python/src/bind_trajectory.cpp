// Motions: paths and plans in time.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <cmath>

#include "mjarm/execution/path_motion.hpp"
#include "mjarm/trajectory/path_timing.hpp"
#include "mjarm/trajectory/trajectory.hpp"
#include "python/src/bindings.hpp"
#include "python/src/convert.hpp"
#include "python/src/interrupt.hpp"
#include "python/src/outcomes.hpp"
#include "python/src/robot.hpp"

namespace mjarm::python {
namespace {

constexpr double kMostSamples = 1e8;

Trajectory time_path_of_tool(const BoundRobot& robot, const BoundPath& path,
                             const TimingOptions& timing) {
  if (path.failure) raise(Error{Errc::impossible, path.what});
  if (path.stops.empty()) refuse(msg::python_no_way);
  return value_of(time_tool_path(path.had, path.stops, robot.arm().limits, timing));
}

Trajectory time_plan(const BoundPlan& plan, const JointLimits& limits) {
  PlanningWorld world = *plan.world;  // another thread may time the same plan
  auto motion = interruptible([&](const StopCheck& stop) -> Result<PathMotion> {
    const auto prover = world.prover({&plan.path, 1}, stop);
    if (!prover) return fail(prover.error());
    return time_path(plan.path.q, limits, *prover, {.stop = stop});
  });
  return value_of(std::move(motion)).trajectory;
}

Trajectory time(const BoundRobot& robot, nb::handle what, double tool_speed, double share) {
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
  std::vector<JointVec> rows;
  const std::vector<double> values = robot.rows(what, "motion");
  const auto dof = static_cast<std::size_t>(robot.dof());
  for (std::size_t i = 0; i < values.size(); i += dof) rows.push_back(joint_vec({&values[i], dof}));
  return value_of(time_waypoint_path(rows, limits));
}

/// Columns t, q, v, a of the states at these times.
nb::tuple states(const Trajectory& motion, const std::vector<double>& times) {
  const auto dof = static_cast<std::size_t>(motion.dof());
  std::vector<double> q, v, a;
  for (const double t : times) {
    const JointState state = motion.at(t);
    q.insert(q.end(), state.q.begin(), state.q.end());
    v.insert(v.end(), state.v.begin(), state.v.end());
    a.insert(a.end(), state.a.begin(), state.a.end());
  }
  const std::size_t n = times.size();
  return nb::make_tuple(array(times, {n}), array(std::move(q), {n, dof}),
                        array(std::move(v), {n, dof}), array(std::move(a), {n, dof}));
}

nb::tuple sample(const Trajectory& motion, double dt) {
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
  nb::class_<Trajectory>(m, "Motion", "A motion in time; joints keep their limits at every moment.")
      .def_prop_ro("duration", &Trajectory::duration, "[s]")
      .def_prop_ro("dof", &Trajectory::dof, "Number of joints.")
      .def(
          "at",
          [](const Trajectory& motion, double t) {
            if (!std::isfinite(t)) refuse(msg::python_seconds);
            const JointState state = motion.at(t);
            return nb::make_tuple(array(state.q), array(state.v), array(state.a));
          },
          nb::arg("t"), nb::sig("def at(self, t: float) -> tuple[Array, Array, Array]"),
          "Positions [rad or m], velocities and accelerations at time `t` [s], each (dof,).")
      .def("sample", &sample, nb::arg("dt"),
           nb::sig("def sample(self, dt: float) -> tuple[Array, Array, Array, Array]"),
           "Times [s], (n,), and positions, velocities, accelerations, (n, dof): every `dt` [s] "
           "and at the end.")
      .def("__repr__", [](const Trajectory& motion) {
        return "<mjarm.Motion: " + std::to_string(motion.duration()) + " s, " +
               std::to_string(motion.dof()) + " joints>";
      });
  auto robot = nb::borrow<nb::class_<BoundRobot>>(m.attr("Robot"));
  robot.def("time", &time, nb::arg("motion"), nb::kw_only(),
            nb::arg("tool_speed") = TimingOptions().tool_speed, nb::arg("share") = 1.0,
            nb::sig("def time(self, motion: Path | Plan | ArrayLike, *, tool_speed: float = 0.25, "
                    "share: float = 1.0) -> "
                    "Motion"),
            "The fastest motion along what is given, from rest to rest, within the limits of "
            "velocity, acceleration and\n"
            "jerk.\n\n"
            "The path of a curve is walked at `tool_speed` [m/s] where the joints can; a plan as "
            "fast as it can be, beside\n"
            "its corners as far as that is proved free; rows of joint values (n, dof) [rad or m] "
            "along the spline through\n"
            "them. `share` of the limits of velocity and acceleration is used.");
}

}  // namespace mjarm::python
