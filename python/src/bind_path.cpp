// Curves of the tool, and the joint values along them.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "mjarm/collision/exact.hpp"
#include "mjarm/path/solve_curve.hpp"
#include "mjarm/trajectory/tool_motion.hpp"
#include "python/src/bindings.hpp"
#include "python/src/convert.hpp"
#include "python/src/interrupt.hpp"
#include "python/src/outcomes.hpp"
#include "python/src/robot.hpp"

namespace mjarm::python {
namespace {

using Solved = Result<JointPath, PathFailure>;

/// How a path is to be followed, as a caller says it.
struct PathWords {
  nb::handle start;
  double max_step, orientation_tol, tool_speed;
  bool collisions, fixes;
};

PathOptions options_of(const BoundRobot& robot, const PathWords& words) {
  if (!is_sound_step(words.max_step)) refuse(msg::python_max_step);
  if (!(words.orientation_tol >= 0 && words.orientation_tol < std::numbers::pi / 2)) {
    refuse(msg::python_tilt);
  }
  if (!(words.tool_speed >= 0)) refuse(msg::python_not_negative, "tool_speed");
  PathOptions options;
  options.max_step = words.max_step;
  options.orientation_tol = words.orientation_tol;
  options.tool_speed = words.tool_speed;
  // Without a start any will do: of the tracks with room enough that with the best postures.
  options.best_posture = words.start.is_none();
  if (words.collisions) options.clearance = clearance_check({robot.robot.model, robot.arm()});
  return options;
}

template <class Along, class Options>
BoundPath outcome(const BoundRobot& robot, const Along& along, const JointVec& q_start,
                  Solved&& solved, const Options& options, const PathOptions& path,
                  bool with_fixes) {
  BoundPath out{.dof = robot.dof()};
  if (solved) {
    out.had = std::move(*solved);
  } else {
    out.failure = std::move(solved.error());
    out.had = out.failure->partial;
    out.what = describe(*out.failure, robot.arm());
    if (with_fixes) {
      out.fixes = find_fixes(robot.ik, along, as_span(q_start), options, *out.failure);
    }
  }
  if (!out.had.q.empty()) {
    out.measures = measure_path(robot.arm(), out.had.q, path.clearance, path.stop);
  }
  return out;
}

BoundPath follow_curve(const BoundRobot& robot, const Curve& curve, const PathWords& words) {
  // As near to the curve as motions want it, which have joints go along splines.
  CurveOptions options{.path = options_of(robot, words),
                       .pos_tol = MotionOptions().pos_tol,
                       .rot_tol = MotionOptions().rot_tol};
  const JointVec q_start = robot.joints_or_home(words.start, "start");
  BoundPath out = interruptible([&](const StopCheck& stop) {
    options.path.stop = stop;
    return outcome(robot, curve, q_start, solve_curve(robot.ik, curve, as_span(q_start), options),
                   options, options.path, words.fixes);
  });
  out.curve = curve;
  return out;
}

BoundPath follow_poses(const BoundRobot& robot, const std::vector<Pose>& poses,
                       const PathWords& words) {
  PathOptions options = options_of(robot, words);
  const JointVec q_start = robot.joints_or_home(words.start, "start");
  if (poses.empty()) refuse(msg::python_empty, "poses");
  return interruptible([&](const StopCheck& stop) {
    options.stop = stop;
    const std::span<const Pose> along = poses;
    return outcome(robot, along, q_start, solve_path(robot.ik, along, as_span(q_start), options),
                   options, options, words.fixes);
  });
}

BoundPath follow(const BoundRobot& robot, nb::handle along, nb::handle start, double max_step,
                 double orientation_tol, double tool_speed, bool collisions, bool fixes) {
  const PathWords words{start, max_step, orientation_tol, tool_speed, collisions, fixes};
  if (nb::isinstance<Curve>(along))
    return follow_curve(robot, nb::cast<const Curve&>(along), words);
  return follow_poses(robot, poses_of(along, "along"), words);
}

BoundPath line(const BoundRobot& robot, nb::handle from, nb::handle to, nb::handle start,
               double max_step, double orientation_tol, double tool_speed, bool collisions,
               bool fixes) {
  const Curve curve = value_of(Curve::line(pose_of(from, "from"), pose_of(to, "to")));
  return follow_curve(robot, curve,
                      {start, max_step, orientation_tol, tool_speed, collisions, fixes});
}

Curve ellipse(nb::handle center, double a, double b, nb::handle normal, nb::handle euler,
              nb::handle quat) {
  const nb::object rotation = nb::type<Pose>()(nb::arg("euler") = euler, nb::arg("quat") = quat);
  return value_of(Curve::ellipse(
      {.center = vector3(center, "center"),
       .a = a,
       .b = b,
       .normal = normal.is_none() ? Eigen::Vector3d::UnitZ().eval() : vector3(normal, "normal"),
       .R = nb::cast<const Pose&>(rotation).R}));
}

/// One pose for a number, a list for an array.
nb::object poses_at(const Curve& curve, nb::handle s) {
  const Reals given = reals(s, "s");
  if (given.ndim() == 0) return nb::cast(curve.at(*given.data()));
  return nb::cast(curve.poses(reals(s, "s", {-1}).span()));
}

void bind_curve(nb::module_& m) {
  nb::class_<Curve>(m, "Curve",
                    "A curve of tool poses in the world, walked by its arc length [m]; where the "
                    "tool turns on the\n"
                    "spot, the parameter counts the angle [rad].")
      .def_static(
          "line",
          [](nb::handle from, nb::handle to) {
            return value_of(Curve::line(pose_of(from, "from"), pose_of(to, "to")));
          },
          nb::arg("start"), nb::arg("end"),
          nb::sig("def line(start: PoseLike, end: PoseLike) -> Curve"),
          "A straight line; the rotation goes along evenly.")
      .def_static(
          "polyline",
          [](nb::handle points, double blend) {
            return value_of(Curve::polyline(poses_of(points, "points"), blend));
          },
          nb::arg("points"), nb::arg("blend") = 0.0,
          nb::sig("def polyline(points: PosesLike, blend: float = 0.0) -> Curve"),
          "Straight pieces through all poses; corners are rounded within `blend` [m] of them.")
      .def_static(
          "arc",
          [](nb::handle from, nb::handle via, nb::handle to) {
            return value_of(
                Curve::arc(pose_of(from, "start"), pose_of(via, "via"), pose_of(to, "end")));
          },
          nb::arg("start"), nb::arg("via"), nb::arg("end"),
          nb::sig("def arc(start: PoseLike, via: PoseLike, end: PoseLike) -> Curve"),
          "A circular arc.")
      .def_static(
          "spline",
          [](nb::handle poses, std::optional<double> corner) {
            return value_of(
                Curve::spline(poses_of(poses, "poses"), corner.value_or(std::numbers::pi)));
          },
          nb::arg("poses"), nb::kw_only(), nb::arg("corner").none() = nb::none(),
          nb::sig("def spline(poses: PosesLike, *, corner: float | None = None) -> Curve"),
          "A smooth curve through all poses; where it turns by more than `corner` [rad] from chord "
          "to chord it has a corner.")
      .def_static("ellipse", &ellipse, nb::arg("center"), nb::arg("a"), nb::arg("b"),
                  nb::arg("normal").none() = nb::none(), nb::kw_only(),
                  nb::arg("euler").none() = nb::none(), nb::arg("quat").none() = nb::none(),
                  nb::sig("def ellipse(center: ArrayLike, a: float, b: float, normal: ArrayLike | "
                          "None = None, *, euler: "
                          "ArrayLike | None = None, quat: ArrayLike | None = None) -> Curve"),
                  "One lap of an ellipse with one orientation of the tool; semi-axes [m], normal z "
                  "by default.")
      .def_prop_ro("length", &Curve::length, "[m]")
      .def_prop_ro("end", &Curve::end, "The largest parameter [m or rad].")
      .def(
          "at",
          [](const Curve& curve, double s) {
            if (!std::isfinite(s)) refuse(msg::python_not_finite, "s");
            return curve.at(s);
          },
          nb::arg("s"), "The pose at a parameter.")
      .def("at", &poses_at, nb::arg("s"), nb::sig("def at(self, s: ArrayLike) -> list[Pose]"),
           "Those at many, (n,).")
      .def(
          "poses",
          [](const Curve& curve, int n) {
            if (n < 2) refuse(msg::python_two);
            std::vector<Pose> out;
            for (int i = 0; i < n; ++i) out.push_back(curve.at(curve.end() * i / (n - 1)));
            return out;
          },
          nb::arg("n"), "`n` poses at even parameters, both ends included.");
}

template <LeastAlong PathMeasures::* kPart>
double least(const BoundPath& path) {
  return (path.measures.*kPart).value;
}

void bind_outcome(nb::module_& m) {
  auto reasons = nb::enum_<PathErrc>(m, "PathReason", "Why a path stops.");
  for (const PathErrc code :
       {PathErrc::out_of_reach, PathErrc::inner_void, PathErrc::joint_limit, PathErrc::singularity,
        PathErrc::collision, PathErrc::branch_flip, PathErrc::joint_speed, PathErrc::no_convergence,
        PathErrc::stopped, PathErrc::bad_input}) {
    reasons.value(name(code).data(), code);
  }
  nb::class_<PathFix>(m, "PathFix", "A change with which a path was solved from end to end.")
      .def_prop_ro(
          "kind", [](const PathFix& fix) { return std::string(name(fix.kind)); },
          "\"start\", \"shift\", \"tilt\", \"max_step\" or \"slower\".")
      .def_prop_ro(
          "shift", [](const PathFix& fix) { return array(fix.change.shift); },
          nb::sig("def shift(self) -> Array"), "[m] of the whole path in the world.")
      .def_prop_ro(
          "tilt", [](const PathFix& fix) { return array(fix.change.tilt); },
          nb::sig("def tilt(self) -> Array"), "[rad] rotation vector in the tool's frame.")
      .def_prop_ro(
          "start", [](const PathFix& fix) { return array(fix.start); },
          nb::sig("def start(self) -> Array"), "Another answer to the first pose; else empty.")
      .def_ro("max_step", &PathFix::max_step, "[rad or m]")
      .def_ro("tool_speed", &PathFix::tool_speed, "[m/s]")
      .def("__str__", [](const PathFix& fix) { return describe(fix); })
      .def("__repr__", [](const PathFix& fix) { return "<PathFix: " + describe(fix) + ">"; });
  nb::class_<BoundPath>(m, "Path", "Joint values along a path of the tool, as far as it goes.")
      .def_prop_ro(
          "ok", [](const BoundPath& p) { return !p.failure; }, "Whether it goes to its end.")
      .def("__bool__", [](const BoundPath& p) { return !p.failure; })
      .def_prop_ro(
          "q", [](const BoundPath& p) { return array(p.had.q, p.dof); },
          nb::sig("def q(self) -> Array"),
          "Joint values [rad or m], shape (n, dof). Of a path that stops: those before it does.")
      .def_prop_ro(
          "s", [](const BoundPath& p) { return array(p.had.s, {p.had.s.size()}); },
          nb::sig("def s(self) -> Array"),
          "Where on its curve each row is [m]; for given poses: their numbers. Shape (n,).")
      .def_prop_ro(
          "fraction", [](const BoundPath& p) { return p.failure ? p.failure->fraction : 1.0; },
          "Share of the path before it stops; 1: all of it.")
      .def_prop_ro(
          "reason",
          [](const BoundPath& p) { return p.failure ? nb::cast(p.failure->code) : nb::none(); },
          nb::sig("def reason(self) -> PathReason | None"), "Why it stops; None where it does not.")
      .def_ro("message", &BoundPath::what,
              "One line: where it stops, why and by how much; empty where it does not.")
      .def_prop_ro(
          "at", [](const BoundPath& p) { return p.failure ? nb::cast(p.failure->at) : nb::none(); },
          nb::sig("def at(self) -> int | None"), "Index of the first pose that cannot be had.")
      .def_prop_ro(
          "amount", [](const BoundPath& p) { return p.failure ? p.failure->amount : 0.0; },
          "By how much it fails [m or rad].")
      .def_ro("fixes", &BoundPath::fixes, "Changes that mend it, the least first; each was tried.")
      .def_prop_ro(
          "max_joint_step", [](const BoundPath& p) { return p.had.max_step(); },
          "Largest step of any joint between rows [rad or m].")
      .def_prop_ro("manipulability", &least<&PathMeasures::manipulability>, "The least along it.")
      .def_prop_ro("limit_room", &least<&PathMeasures::limit_room>,
                   "The least distance to a limit [rad or m].")
      .def_prop_ro("clearance", &least<&PathMeasures::clearance>,
                   "The least distance to anything [m], up to 0.1; inf without collisions.")
      .def("__len__", [](const BoundPath& p) { return p.had.q.size(); })
      .def("__repr__", [](const BoundPath& p) {
        if (p.failure) return "<mjarm.Path: " + p.what + ">";
        return "<mjarm.Path: " + std::to_string(p.had.q.size()) + " rows of " +
               std::to_string(p.dof) + " joints>";
      });
}

constexpr const char* kFollow =
    R"(Joint values along a curve or given poses, chosen for the whole path at once.

Parameters
----------
along : Curve, or poses
    What the tool shall follow: a curve, a list of poses, or an array (n, 4, 4).
start : array_like, shape (dof,), optional
    Where the arm is before [rad or m]. Without it, any track will do that has good postures.
max_step : float, optional
    Largest step of any joint between rows [rad or m].
orientation_tol : float, optional
    So much the tool may lean aside [rad], to pass a singularity.
tool_speed : float, optional
    The tool is to keep this speed [m/s]; 0: it may slow down.
collisions : bool, optional
    Refuse overlap, prefer distance.
fixes : bool, optional
    Where it stops, look for changes that mend it.

Returns
-------
Path
    Also where it stops; `ok`, `fraction`, `reason` and `fixes` tell.
)";

constexpr const char* kFollowSig =
    "def follow(self, along: Curve | PosesLike, start: ArrayLike | None = None, *, max_step: float "
    "= 0.5, "
    "orientation_tol: float = 0.0, tool_speed: float = 0.0, collisions: bool = True, fixes: bool = "
    "True) -> Path";

constexpr const char* kLineSig =
    "def line(self, begin: PoseLike, end: PoseLike, start: ArrayLike | None = None, *, max_step: "
    "float = 0.5, "
    "orientation_tol: float = 0.0, tool_speed: float = 0.0, collisions: bool = True, fixes: bool = "
    "True) -> Path";

}  // namespace

void bind_path(nb::module_& m) {
  bind_curve(m);
  bind_outcome(m);
  const PathOptions usual;
  auto robot = nb::borrow<nb::class_<BoundRobot>>(m.attr("Robot"));
  robot
      .def("follow", &follow, nb::arg("along"), nb::arg("start").none() = nb::none(), nb::kw_only(),
           nb::arg("max_step") = usual.max_step, nb::arg("orientation_tol") = 0.0,
           nb::arg("tool_speed") = 0.0, nb::arg("collisions") = true, nb::arg("fixes") = true,
           nb::sig(kFollowSig), kFollow)
      .def("line", &line, nb::arg("begin"), nb::arg("end"), nb::arg("start").none() = nb::none(),
           nb::kw_only(), nb::arg("max_step") = usual.max_step, nb::arg("orientation_tol") = 0.0,
           nb::arg("tool_speed") = 0.0, nb::arg("collisions") = true, nb::arg("fixes") = true,
           nb::sig(kLineSig), "follow() of the straight line between two poses.");
}

}  // namespace mjarm::python
