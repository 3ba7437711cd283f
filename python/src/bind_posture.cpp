// What an arm can do where: branches, freedom left over, workspaces, and how two arms differ.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <utility>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/branch.hpp"
#include "mjarm/kinematics/compare.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/manipulability_ellipsoid.hpp"
#include "mjarm/kinematics/self_motion.hpp"
#include "mjarm/kinematics/workspace.hpp"
#include "python/src/bindings.hpp"
#include "python/src/convert.hpp"
#include "python/src/interrupt.hpp"
#include "python/src/robot.hpp"

namespace mjarm::python {
namespace {

IkSolution null_space(const BoundRobot& robot, nb::handle pose, nb::handle q,
                      const std::string& goal, nb::handle posture) {
  SelfMotionOptions options;
  if (goal == "near_posture") {
    options.goal = PostureGoal::near_posture;
    options.posture = robot.joints_or_home(posture, "posture");
  } else if (goal == "manipulability") {
    options.goal = PostureGoal::manipulability;
  } else if (goal != "away_from_limits") {
    refuse(msg::python_posture_goal, goal);
  }
  const Pose X_WT = pose_of(pose, "pose");
  const JointVec from = robot.joints(q, "q");
  const auto answer = null_space_step(robot.ik, X_WT, as_span(from), options);
  const Pose X = fk(robot.arm(), as_span(from));
  const double off = (X.p - X_WT.p).norm(), turned = angle_between(X.R, X_WT.R);
  if (!answer && (off > robot.ik.options().pos_tol || turned > robot.ik.options().rot_tol)) {
    refuse(msg::python_not_at_pose, off, turned);
  }
  if (!answer) raise_bad_input(describe(answer.error(), robot.arm()));
  return *answer;
}

nb::tuple ellipsoid(const BoundRobot& robot, nb::handle q) {
  const VelocityEllipsoid found =
      manipulability_ellipsoid(robot.arm(), as_span(robot.joints(q, "q")));
  std::vector<double> axes;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) axes.push_back(found.R_WE(row, column));
  }
  return nb::make_tuple(array(std::move(axes), {3, 3}), array(found.semi_axes));
}

WorkspaceMap workspace(const BoundRobot& robot, const std::string& normal, double at, double step,
                       nb::handle orientation, int threads) {
  constexpr std::string_view kAxes = "xyz";
  const std::size_t axis = normal.size() == 1 ? kAxes.find(normal) : std::string::npos;
  if (axis == std::string::npos) refuse(msg::python_axis, normal);
  if (threads < 1) refuse(msg::python_positive, "threads");
  WorkspaceOptions options{
      .normal = static_cast<int>(axis), .at = at, .step = step, .threads = threads};
  if (!orientation.is_none()) options.R_WT = pose_of(orientation, "orientation").R;
  return value_of(interruptible([&](const StopCheck& stop) {
    options.stop = stop;
    return map_workspace(robot.arm(), options);
  }));
}

std::vector<double> middles(double first, double step, int count) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(first + step * i);
  return out;
}

void bind_workspace(nb::module_& m) {
  nb::class_<WorkspaceMap>(m, "Workspace",
                           "Where the tool can go on a slice of space, cell by cell.")
      .def_prop_ro(
          "u",
          [](const WorkspaceMap& w) {
            return array(middles(w.u_first, w.step, w.columns),
                         {static_cast<std::size_t>(w.columns)});
          },
          nb::sig("def u(self) -> Array"),
          "Middles of the columns [m], along the first of the two axes of the slice.")
      .def_prop_ro(
          "v",
          [](const WorkspaceMap& w) {
            return array(middles(w.v_first, w.step, w.rows), {static_cast<std::size_t>(w.rows)});
          },
          nb::sig("def v(self) -> Array"), "Middles of the rows [m], along the second.")
      .def_prop_ro(
          "branches",
          [](const WorkspaceMap& w) {
            return array<double>(w.branches, {static_cast<std::size_t>(w.rows),
                                              static_cast<std::size_t>(w.columns)});
          },
          nb::sig("def branches(self) -> Array"),
          "Answers apart from windings, (rows, columns); 0: none. 1 for any where `counted` is "
          "false.")
      .def_prop_ro(
          "manipulability",
          [](const WorkspaceMap& w) {
            return array(w.manipulability,
                         {static_cast<std::size_t>(w.rows), static_cast<std::size_t>(w.columns)});
          },
          nb::sig("def manipulability(self) -> Array"),
          "The best of the answers, (rows, columns); NaN: none.")
      .def_ro("counted", &WorkspaceMap::counted,
              "False where the arm has joints to spare, so that there is no number of answers.")
      .def("__repr__", [](const WorkspaceMap& w) {
        return "<mjarm.Workspace: " + std::to_string(w.rows) + " x " + std::to_string(w.columns) +
               " cells>";
      });
}

void bind_comparison(nb::module_& m) {
  nb::class_<Comparison>(m, "Comparison", "How two arms differ in forward kinematics.")
      .def_ro("position", &Comparison::position, "Largest distance of the tools [m].")
      .def_ro("rotation", &Comparison::rotation, "Largest angle between them [rad].")
      .def_prop_ro(
          "q", [](const Comparison& c) { return array(c.q); }, nb::sig("def q(self) -> Array"),
          "Where that is [rad or m].")
      .def_prop_ro(
          "causes",
          [](const Comparison& c) {
            std::vector<std::string> words;
            for (const Cause& cause : c.causes) words.emplace_back(name(cause.code));
            return words;
          },
          "Words of the shortest explanation, from base to tool: joint_order, base, link, "
          "zero_offset, joint_sign, tool.")
      .def_ro("position_left", &Comparison::position_left, "What is left when they are mended [m].")
      .def_ro("rotation_left", &Comparison::rotation_left, "Likewise [rad].");
}

}  // namespace

void bind_posture(nb::module_& m) {
  bind_workspace(m);
  bind_comparison(m);
  auto robot = nb::borrow<nb::class_<BoundRobot>>(m.attr("Robot"));
  robot
      .def(
          "branch",
          [](const BoundRobot& r, nb::handle q) {
            return describe(branch_of(r.ik, as_span(r.joints(q, "q"))));
          },
          nb::arg("q"), nb::sig("def branch(self, q: ArrayLike) -> str"),
          "Which way the arm is bent at `q`, such as \"shoulder=left,elbow=up,wrist=no_flip\"; "
          "parts "
          "that are not known of\nit are left out.")
      .def("null_space", &null_space, nb::arg("pose"), nb::arg("q"),
           nb::arg("goal") = "away_from_limits", nb::arg("posture").none() = nb::none(),
           nb::sig("def null_space(self, pose: PoseLike, q: ArrayLike, goal: str = "
                   "'away_from_limits', posture: ArrayLike | None = None) -> IkSolution"),
           "Moves an answer `q` [rad or m] to `pose` along the self-motion of the arm, the tool at "
           "rest, to "
           "where a goal is best\nmet: \"away_from_limits\", \"manipulability\", or "
           "\"near_posture\" (by default "
           "home).")
      .def("ellipsoid", &ellipsoid, nb::arg("q"),
           nb::sig("def ellipsoid(self, q: ArrayLike) -> tuple[Array, Array]"),
           "The manipulability ellipsoid of the tool's position: principal axes as columns (3, 3), "
           "and "
           "semi-axes (3,),\ndescending [m/s a unit of joint speed] (T. Yoshikawa, IJRR 4 (1985) "
           "3).")
      .def("workspace", &workspace, nb::arg("normal") = "z", nb::arg("at") = 0.4,
           nb::arg("step") = 0.02, nb::kw_only(), nb::arg("orientation").none() = nb::none(),
           nb::arg("threads") = 1,
           nb::sig("def workspace(self, normal: str = 'z', at: float = 0.4, step: float = 0.02, *, "
                   "orientation: PoseLike | None = None, threads: int = 1) -> Workspace"),
           "Where the tool can go on the slice across an axis of the world, in cells of `step` "
           "[m]; with "
           "`orientation` the tool\nhas that of a pose, without any will do.")
      .def(
          "compare",
          [](const BoundRobot& r, const BoundRobot& other, int configurations, std::uint64_t seed) {
            if (configurations < 1) refuse(msg::python_positive, "configurations");
            return value_of(compare_arms(r.arm(), other.arm(),
                                         {.configurations = configurations, .seed = seed}));
          },
          nb::arg("other"), nb::kw_only(), nb::arg("configurations") = 1000, nb::arg("seed") = 1,
          "Where two descriptions of one arm put their tools, and why they differ.");
}

}  // namespace mjarm::python
