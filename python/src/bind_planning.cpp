// Contacts, and paths without any.
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <optional>

#include "mjarm/collision/exact.hpp"
#include "mjarm/planning/planning_world.hpp"
#include "mjarm/planning/verify_path.hpp"
#include "python/src/bindings.hpp"
#include "python/src/convert.hpp"
#include "python/src/interrupt.hpp"
#include "python/src/outcomes.hpp"
#include "python/src/robot.hpp"

namespace mjarm::python {
namespace {

using Names = std::vector<std::string>;
using Pairs = std::vector<std::array<std::string, 2>>;

/// @param q  where the arm holds those bodies as they stand.
ContactRules rules_of(const BoundRobot& robot, const Names& held, const Pairs& allowed,
                      const JointVec& q) {
  ContactRules rules{.allowed = allowed};
  for (const std::string& body : held) {
    rules.attached.push_back(
        value_of(attach_in_place(robot.robot.model, robot.arm(), body, as_span(q))));
  }
  value_of(check_contact_rules(robot.robot.model, robot.arm(), rules));
  return rules;
}

CollisionReport check(const BoundRobot& robot, nb::handle q, double margin, const Names& held,
                      const Pairs& allowed) {
  const JointVec values = robot.joints(q, "q");
  ExactChecker checker = value_of(ExactChecker::create(
      robot.robot.model, robot.arm(),
      {.margin = margin, .rules = rules_of(robot, held, allowed, robot.arm().home)}));
  return value_of(checker.check(as_span(values)));
}

void bind_contacts(nb::module_& m) {
  nb::class_<ContactPoint>(m, "Contact", "Two shapes that overlap, where they do so most.")
      .def_prop_ro(
          "geoms", [](const ContactPoint& c) { return std::pair(c.pair.geom1, c.pair.geom2); },
          "Their names.")
      .def_prop_ro(
          "bodies", [](const ContactPoint& c) { return std::pair(c.pair.body1, c.pair.body2); },
          "The bodies they belong to.")
      .def_ro("depth", &ContactPoint::depth, "Overlap along the normal [m], > 0.")
      .def_prop_ro(
          "point", [](const ContactPoint& c) { return array(c.point_W); },
          nb::sig("def point(self) -> Array"), "Midway between the two surfaces, in the world [m].")
      .def_prop_ro(
          "normal", [](const ContactPoint& c) { return array(c.normal_W); },
          nb::sig("def normal(self) -> Array"), "Unit vector from the first to the second.");
  nb::class_<CollisionReport>(m, "CollisionReport",
                              "What one configuration touches, or comes near to.")
      .def_ro("free", &CollisionReport::free, "Nothing overlaps.")
      .def_ro("contacts", &CollisionReport::contacts,
              "One a pair that overlaps, the deepest first.")
      .def_prop_ro(
          "distance",
          [](const CollisionReport& r) {
            return r.nearest ? r.nearest->distance : std::numeric_limits<double>::infinity();
          },
          "To what is nearest [m]; negative where it overlaps, inf beyond the margin.")
      .def_prop_ro(
          "nearest",
          [](const CollisionReport& r) {
            return r.nearest ? nb::cast(std::pair(r.nearest->pair.geom1, r.nearest->pair.geom2))
                             : nb::none();
          },
          nb::sig("def nearest(self) -> tuple[str, str] | None"),
          "Names of the two shapes that are nearest.")
      .def("__bool__", [](const CollisionReport& r) { return r.free; })
      .def("__repr__",
           [](const CollisionReport& r) { return "<mjarm.CollisionReport: " + describe(r) + ">"; });
}

void bind_reasons(nb::module_& m) {
  nb::enum_<PlanErrc>(m, "PlanReason", "Why there is no plan.")
      .value("bad_input", PlanErrc::bad_input)
      .value("bad_tilt", PlanErrc::bad_tilt)
      .value("bad_region", PlanErrc::bad_region)
      .value("bad_clearance", PlanErrc::bad_clearance)
      .value("base_hit", PlanErrc::base_hit)
      .value("start_outside", PlanErrc::start_outside)
      .value("start_hit", PlanErrc::start_hit)
      .value("goals_outside", PlanErrc::goals_outside)
      .value("goals_hit", PlanErrc::goals_hit)
      .value("start_tilted", PlanErrc::start_tilted)
      .value("goals_tilted", PlanErrc::goals_tilted)
      .value("start_off", PlanErrc::start_off)
      .value("goals_off", PlanErrc::goals_off)
      .value("enclosed", PlanErrc::enclosed, "Proved: there is none.")
      .value("barred", PlanErrc::barred, "Proved: there is none.")
      .value("budget_spent", PlanErrc::budget_spent)
      .value("out_of_time", PlanErrc::out_of_time)
      .value("stopped", PlanErrc::stopped)
      .value("too_near", PlanErrc::too_near)
      .value("unproved", PlanErrc::unproved)
      .value("not_available", PlanErrc::not_available)
      .value("tilt_with_ompl", PlanErrc::tilt_with_ompl)
      .value("back_end", PlanErrc::back_end);
}

/// Joint values (dof,) or (n, dof), a pose or a region, or several.
PathEnd goal_of(const BoundRobot& robot, nb::handle goal) {
  PathEnd out;
  const auto is_place = [](nb::handle one) {
    return nb::isinstance<Pose>(one) || nb::isinstance<TaskRegion>(one);
  };
  const auto add = [&](nb::handle one) {
    out.regions.push_back(nb::isinstance<TaskRegion>(one) ? nb::cast<const TaskRegion&>(one)
                                                          : region_about(pose_of(one, "goal")));
  };
  if (is_place(goal)) {
    add(goal);
  } else if (nb::isinstance<nb::sequence>(goal) && nb::len(goal) > 0 && is_place(goal[0])) {
    for (const nb::handle one : goal) add(one);
  } else if (const Reals given = reals(goal, "goal");
             given.ndim() == 2 && given.shape(0) == 4 && given.shape(1) == 4 && robot.dof() != 4) {
    add(goal);
  } else if (given.ndim() == 2) {
    const std::size_t width = given.shape(1);
    for (std::size_t i = 0; i < given.shape(0); ++i) {
      out.q.push_back(robot.joints(given.span().subspan(i * width, width), "goal"));
    }
  } else {
    out.q.push_back(robot.joints(goal, "goal"));
  }
  if (out.q.empty() && out.regions.empty()) refuse(msg::python_empty, "goal");
  return out;
}

[[noreturn]] void raise_no_path(const WorldFailure& failure) {
  if (failure.code == WorldErrc::bad_model) raise_bad_input(failure.what);
  nb::object exception =
      error_class(failure.code == WorldErrc::no_answer ? "Unreachable" : "NoPath")(failure.what);
  if (failure.code == WorldErrc::no_path) {
    exception.attr("reason") = nb::cast(failure.search.code);
    exception.attr("samples") = failure.search.samples;
  }
  raise(exception);
}

BoundPlan plan(const BoundRobot& robot, nb::handle start, nb::handle goal, const Names& held,
               const Pairs& allowed, std::optional<double> upright,
               std::optional<TaskRegion> within, std::optional<double> clearance, double margin,
               nb::handle qpos, std::uint64_t seed, int samples, int rounds, double time_limit) {
  const JointVec q_start = robot.joints_or_home(start, "start");
  const PathEnd end = goal_of(robot, goal);
  WorldOptions world{.rules = rules_of(robot, held, allowed, q_start), .margin = margin};
  world.qpos = qpos_of(qpos, robot.robot.model);
  if (samples < 0 || rounds < 0 || !(time_limit >= 0)) {
    refuse(msg::python_not_negative, "samples, rounds, time_limit");
  }
  PlanOptions options{.seed = seed,
                      .samples = samples,
                      .time_limit = time_limit,
                      .rounds = rounds,
                      .within = std::move(within),
                      .clearance = clearance};
  if (upright) options.tilt = keep_upright(robot.arm(), as_span(q_start), *upright);
  const auto planner =
      std::make_shared<PlanningWorld>(value_of(PlanningWorld::create(robot.robot, world)));
  auto path = interruptible([&](const StopCheck& stop) {
    options.stop = stop;
    return planner->plan({.q = {q_start}}, end, options);
  });
  if (!path) raise_no_path(path.error());
  return {.robot = robot.robot,
          .path = std::move(*path),
          .rules = std::move(world.rules),
          .world = planner};
}

std::vector<std::string> verify(const BoundRobot& robot, const BoundPlan& plan, double step) {
  if (!(step >= kLeastVerifyStep)) refuse(msg::python_verify_step);
  GivenPath rows;
  for (const JointVec& q : plan.path.q) rows.rows.emplace_back(q.begin(), q.end());
  const auto verdict = interruptible([&](const StopCheck& stop) {
    return verify_path(robot.robot, plan.rules, rows, {.step = step, .stop = stop});
  });
  if (!verdict) raise(verdict.error());
  std::vector<std::string> out;
  for (const PathFault& fault : verdict->faults) out.push_back(fault.what);
  return out;
}

void bind_plan(nb::module_& m) {
  nb::class_<BoundPlan>(m, "Plan",
                        "A path of straight edges in joint space, each proved to be free.")
      .def_prop_ro(
          "path", [](const BoundPlan& p) { return array(p.path.q, p.robot.arm.dof()); },
          nb::sig("def path(self) -> Array"),
          "Corners [rad or m], start and goal included, shape (n, dof).")
      .def_prop_ro(
          "length", [](const BoundPlan& p) { return p.path.cost; }, "In joint space [rad or m].")
      .def_prop_ro(
          "goal", [](const BoundPlan& p) { return p.path.goal; }, "Which of the goals it reaches.")
      .def_prop_ro(
          "clearance", [](const BoundPlan& p) { return p.path.clearance; },
          "What every configuration keeps from everything [m]; 0: nothing is promised but no "
          "contact.")
      .def_prop_ro(
          "certificate",
          [](const BoundPlan& p) {
            nb::list edges;
            for (const EdgeCertificate& edge : p.path.proof) {
              std::vector<double> values;
              for (const EdgeInterval& part : edge.intervals)
                values.insert(values.end(), {part.t, part.half});
              edges.append(array(std::move(values), {edge.intervals.size(), 2}));
            }
            return edges;
          },
          nb::sig("def certificate(self) -> list[Array]"),
          "What proves each edge: intervals [t - half, t + half] of it, rows (t, half), that cover "
          "0 to 1.")
      .def_prop_ro(
          "samples", [](const BoundPlan& p) { return p.path.counts.samples; },
          "Configurations that were drawn.")
      .def("__len__", [](const BoundPlan& p) { return p.path.q.size(); })
      .def("__repr__", [](const BoundPlan& p) {
        return "<mjarm.Plan: " + std::to_string(p.path.q.size() - 1) + " edges, length " +
               std::to_string(p.path.cost) + ">";
      });
}

constexpr const char* kPlan = R"(A path without contact, every edge of it proved.

Parameters
----------
start : array_like, shape (dof,), optional
    Where the arm is [rad or m]; None: home.
goal : array_like, Pose or Region
    Joint values (dof,), several (n, dof), a pose of the tool, a region of poses or a list of these: the shortest path to
    any is taken.
held : sequence of str, optional
    Bodies that are attached to the tool, as they stand while the arm is at `start`.
allowed : sequence of (str, str), optional
    Bodies or shapes that may touch.
upright : float, optional
    What points up at the start leans by no more than this all the way [rad].
within : Region, optional
    The tool stays in it all the way.
clearance : float, optional
    What is kept from everything [m]; None: 5 mm where a path with it is soon found.
margin : float, optional
    What start and goal have to keep as well [m].
qpos : array_like, shape (nq,), optional
    How all else stands; default: as at home.
seed, samples, rounds, time_limit
    Same seed, same path; budget of configurations (0: 100,000); searches for something shorter; wall clock [s].

Returns
-------
Plan

Raises
------
NoPath
    With `reason` and `samples`.
Unreachable
    No joint values put the tool to the goal.
)";

}  // namespace

void bind_planning(nb::module_& m) {
  bind_contacts(m);
  bind_reasons(m);
  bind_plan(m);
  auto robot = nb::borrow<nb::class_<BoundRobot>>(m.attr("Robot"));
  robot
      .def("check", &check, nb::arg("q"), nb::kw_only(), nb::arg("margin") = 0.1,
           nb::arg("held") = Names(), nb::arg("allowed") = Pairs(),
           nb::sig("def check(self, q: ArrayLike, *, margin: float = 0.1, held: Sequence[str] = "
                   "(), allowed: "
                   "Sequence[tuple[str, str]] = ()) -> CollisionReport"),
           "What the arm touches at `q` [rad or m], by MuJoCo's own shapes; true where nothing "
           "overlaps. What is within\n"
           "`margin` [m] is measured as well; 0 is quicker by far where only touching counts.")
      .def("plan", &plan, nb::arg("start").none(), nb::arg("goal"), nb::kw_only(),
           nb::arg("held") = Names(), nb::arg("allowed") = Pairs(),
           nb::arg("upright").none() = nb::none(), nb::arg("within").none() = nb::none(),
           nb::arg("clearance").none() = nb::none(), nb::arg("margin") = 0.0,
           nb::arg("qpos").none() = nb::none(), nb::arg("seed") = 1, nb::arg("samples") = 0,
           nb::arg("rounds") = 0, nb::arg("time_limit") = PlanOptions().time_limit,
           nb::sig("def plan(self, start: ArrayLike | None, goal: ArrayLike | PoseLike | "
                   "Region | Sequence[Pose | Region], *, held: "
                   "Sequence[str] = (), allowed: Sequence[tuple[str, str]] = (), upright: float | "
                   "None = None, within: Region | None = None, clearance: "
                   "float | None = None, margin: float = 0.0, qpos: ArrayLike | None = None, seed: "
                   "int = 1, samples: int = 0, "
                   "rounds: int = 0, time_limit: float = 10.0) -> Plan"),
           kPlan)
      .def("verify", &verify, nb::arg("plan"), nb::arg("step") = VerifyRules().step,
           "Judges a plan by MuJoCo's own collision detection, every `step` [rad or m]: one line a "
           "fault, none where it\n"
           "is valid.");
}

}  // namespace mjarm::python
