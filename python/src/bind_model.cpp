// Robots: files, arms and their limits.
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cmath>

#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/joint_values.hpp"
#include "mjarm/model/payload.hpp"
#include "python/src/bindings.hpp"
#include "python/src/convert.hpp"
#include "python/src/robot.hpp"

namespace mjarm::python {

JointVec BoundRobot::joints(nb::handle value, const char* name) const {
  const Reals given = reals(value, name);
  return joints(given.ndim() == 1 ? given.span() : std::span<const double>(), name);
}

JointVec BoundRobot::joints(std::span<const double> values, const char* name) const {
  const auto n = static_cast<std::size_t>(dof());
  const auto nq = static_cast<std::size_t>(robot.model.nq());
  if (values.size() != n && values.size() != nq) {
    if (n == nq) refuse(msg::python_joints, name, n);
    refuse(msg::python_joints_or_qpos, name, n, nq);
  }
  const JointVec q = values.size() == n ? joint_vec(values) : joints_in(values, arm());
  value_of(check_joint_units(as_span(q), arm()));
  return q;
}

Pose BoundRobot::moved_base(nb::handle value) const {
  if (!base) return {};
  const Reals given = reals(value, "q");
  const auto nq = static_cast<std::size_t>(robot.model.nq());
  if (given.ndim() != 1 || given.size() != nq || nq == static_cast<std::size_t>(dof())) return {};
  const Pose X_home = value_of(frame_pose(robot.model, *base));
  return value_of(frame_pose(robot.model, *base, given.span())) * X_home.inverse();
}

JointVec BoundRobot::joints_or_home(nb::handle value, const char* name) const {
  return value.is_none() ? arm().home : joints(value, name);
}

std::vector<double> BoundRobot::rows(nb::handle value, const char* name) const {
  const Reals given = reals(value, name, {-1, dof()});
  return {given.data(), given.data() + given.size()};
}

std::vector<JointVec> BoundRobot::waypoints(nb::handle value, const char* name) const {
  const std::vector<double> values = rows(value, name);
  const auto n = static_cast<std::size_t>(dof());
  std::vector<JointVec> out;
  for (std::size_t i = 0; i < values.size(); i += n) {
    out.push_back(joint_vec({&values[i], n}));
    value_of(check_joint_units(as_span(out.back()), arm()));
  }
  return out;
}

JointVec joints_in(std::span<const double> qpos, const Arm& arm) {
  JointVec q(arm.dof());
  for (int i = 0; i < arm.dof(); ++i) {
    q[i] = qpos[static_cast<std::size_t>(arm.joints[static_cast<std::size_t>(i)].qpos)];
  }
  return q;
}

std::vector<double> qpos_of(nb::handle value, const Model& model) {
  if (value.is_none()) return {};
  const Reals whole = reals(value, "qpos", {model.nq()});
  return {whole.data(), whole.data() + whole.size()};
}

namespace {

/// Other classes of MuJoCo's package have an address as well.
bool is_mujoco_model(nb::handle object) {
  return nb::hasattr(object, "_address") &&
         nb::cast<std::string>(object.type().attr("__name__")) == "MjModel";
}

/// A name, a path, or a mujoco.MjModel.
Robot load(nb::handle model, const std::string& tip, bool allow_outside, bool looks,
           const std::vector<std::filesystem::path>& packages) {
  if (is_mujoco_model(model)) {
    const auto address = nb::cast<std::uintptr_t>(model.attr("_address"));
    Model copy = Model::copy_of(reinterpret_cast<const mjModel_*>(address));
    Arm arm = value_of(find_arm(copy, {.tip = tip}));
    return {std::move(copy), std::move(arm)};
  }
  const std::string path = path_text(model);
  const RobotOptions options{
      .tip = tip,
      .load = {.package_paths = packages, .allow_outside = allow_outside, .looks = looks}};
  const nb::gil_scoped_release free;
  Result<Robot> robot = load_robot(path, options);
  if (robot) return std::move(*robot);
  const nb::gil_scoped_acquire bound;
  raise(robot.error());
}

template <JointVec JointLimits::* kPart>
nb::object limit(const JointLimits& limits) {
  return array(limits.*kPart);
}

void bind_limits(nb::module_& m) {
  nb::class_<JointLimits>(m, "JointLimits",
                          "What the joints may do, each an array of shape (dof,).")
      .def_prop_ro("lower", &limit<&JointLimits::lower>, nb::sig("def lower(self) -> Array"),
                   "Lowest positions [rad or m]; -inf for a joint without stops.")
      .def_prop_ro("upper", &limit<&JointLimits::upper>, nb::sig("def upper(self) -> Array"),
                   "Highest positions [rad or m].")
      .def_prop_ro("velocity", &limit<&JointLimits::velocity>,
                   nb::sig("def velocity(self) -> Array"), "[rad/s or m/s]")
      .def_prop_ro("acceleration", &limit<&JointLimits::acceleration>,
                   nb::sig("def acceleration(self) -> Array"), "[rad/s^2 or m/s^2]")
      .def_prop_ro("jerk", &limit<&JointLimits::jerk>, nb::sig("def jerk(self) -> Array"),
                   "[rad/s^3 or m/s^3]")
      .def_prop_ro("torque", &limit<&JointLimits::torque>, nb::sig("def torque(self) -> Array"),
                   "[N m or N]");
}

void bind_payload(nb::module_& m) {
  nb::class_<Payload>(m, "Payload",
                      R"(What hangs at the tool beside what the model has there, as a point mass.

Parameters
----------
mass : float
    [kg], 0 or more.
center : array_like, shape (3,), optional
    Centre of mass in the frame of the tool [m].
)")
      .def(
          "__init__",
          [](Payload* self, double mass, nb::handle center) {
            if (!(mass >= 0) || !std::isfinite(mass)) refuse(msg::python_payload);
            new (self) Payload{mass, vector3(center, "center")};
          },
          nb::arg("mass"), nb::arg("center") = nb::make_tuple(0, 0, 0),
          nb::sig("def __init__(self, mass: float, center: ArrayLike = (0, 0, 0)) -> None"))
      .def_prop_ro(
          "mass", [](const Payload& p) { return p.mass; }, "[kg]")
      .def_prop_ro(
          "center", [](const Payload& p) { return array(p.center); },
          nb::sig("def center(self) -> Array"), "In the frame of the tool [m], (3,).")
      .def("__repr__", [](const Payload& p) {
        return nb::str("<mjarm.Payload: {:.4f} kg at ({:.4f}, {:.4f}, {:.4f}) m>")
            .format(p.mass, p.center.x(), p.center.y(), p.center.z());
      });
}

}  // namespace

void bind_model(nb::module_& m) {
  bind_limits(m);
  bind_payload(m);
  m.def(
      "shipped_models",
      [] {
        std::vector<std::string> names;
        for (const ShippedModel& one : shipped_models()) names.push_back(one.name);
        return names;
      },
      "Names of the robots that come with mjarm.");
  nb::class_<BoundRobot>(m, "Robot", R"(A robot and its scene, loaded from a file.

Parameters
----------
model : str, os.PathLike or mujoco.MjModel
    The name of a robot that comes with mjarm ("ur5e", "panda"), the path of an MJCF or URDF file, or
    a model that is loaded already, which is copied.
tip : str, optional
    The frame (site or body) that is the tool; by default the only sensible one.
packages : sequence of path, optional
    Where the `package://` of a URDF is looked for first.
allow_outside : bool, optional
    Read meshes and includes outside of the folder of the model as well.
looks : bool, optional
    Keep what is only seen. Without it big files load in a fraction of the time.

Raises
------
BadInput
    One line that names the file and the element.
)")
      .def(
          "__init__",
          [](BoundRobot* self, nb::handle model, const std::string& tip,
             const std::vector<std::filesystem::path>& packages, bool allow_outside, bool looks) {
            new (self) BoundRobot(load(model, tip, allow_outside, looks, packages));
          },
          nb::arg("model"), nb::kw_only(), nb::arg("tip") = "",
          nb::arg("packages") = std::vector<std::filesystem::path>(),
          nb::arg("allow_outside") = false, nb::arg("looks") = true,
          nb::sig(
              "def __init__(self, model: str | os.PathLike[str] | Any, *, tip: str = '', packages: "
              "Sequence[str | os.PathLike[str]] = (), allow_outside: bool = False, looks: bool = "
              "True) -> None"))
      .def_prop_ro(
          "name", [](const BoundRobot& r) { return r.arm().name; }, "Name in its file.")
      .def_prop_ro(
          "file", [](const BoundRobot& r) { return r.robot.model.file(); },
          "Path of its file; empty for a model that was loaded elsewhere.")
      .def_prop_ro("dof", &BoundRobot::dof, "Number of the arm's joints.")
      .def_prop_ro(
          "joints",
          [](const BoundRobot& r) {
            std::vector<std::string> names;
            for (const ArmJoint& joint : r.arm().joints) names.push_back(joint.name);
            return names;
          },
          "Names of the joints from base to tip.")
      .def_prop_ro(
          "tip", [](const BoundRobot& r) { return r.arm().tip; }, "Name of the tool frame.")
      .def_prop_ro(
          "home", [](const BoundRobot& r) { return array(r.arm().home); },
          nb::sig("def home(self) -> Array"), "The posture it starts in [rad or m], shape (dof,).")
      .def_prop_ro(
          "limits", [](const BoundRobot& r) -> const JointLimits& { return r.arm().limits; },
          nb::rv_policy::reference_internal, "What the joints may do.")
      .def_prop_ro(
          "timestep", [](const BoundRobot& r) { return r.robot.model.timestep(); },
          "Time step of its simulation [s].")
      .def_prop_ro(
          "warnings",
          [](const BoundRobot& r) {
            const auto lines = r.robot.model.warnings();
            return std::vector<std::string>(lines.begin(), lines.end());
          },
          "What was odd about the file though it loads, one line each.")
      .def(
          "frame",
          [](const BoundRobot& r, const std::string& name) {
            return value_of(frame_pose(r.robot.model, name));
          },
          nb::arg("name"), "Pose of a site or body in the world where everything stands at home.")
      .def(
          "with_tool",
          [](const BoundRobot& r, nb::handle X_TN) {
            Robot other = r.robot;
            other.arm.X_JT = other.arm.X_JT * pose_of(X_TN, "tool");
            return BoundRobot(std::move(other));
          },
          nb::arg("tool"), nb::sig("def with_tool(self, tool: PoseLike) -> Robot"),
          "With another tool frame, given in this one; for kinematics alone.")
      .def("__repr__", [](const BoundRobot& r) {
        return "<mjarm.Robot '" + r.arm().name + "', " + std::to_string(r.dof()) +
               " joints, tool '" + r.arm().tip + "'>";
      });
}

}  // namespace mjarm::python
