// Simulation: motions that are executed, and what came of them.
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "python/src/bindings.hpp"
#include "python/src/convert.hpp"
#include "python/src/images.hpp"
#include "python/src/interrupt.hpp"
#include "python/src/robot.hpp"
#include "python/src/run.hpp"

namespace mjarm::python {
namespace {

constexpr double kMostRest = 3600;  // [s]

/// One motion, or several one after another.
std::vector<PlannedMove> moves_of(const BoundRobot& robot, nb::handle motion) {
  std::vector<PlannedMove> moves;
  if (nb::isinstance<PlannedMove>(motion)) {
    moves.push_back(nb::cast<const PlannedMove&>(motion));
  } else if (nb::isinstance<nb::sequence>(motion)) {
    for (const nb::handle one : motion) {
      if (!nb::isinstance<PlannedMove>(one)) refuse(msg::python_motions);
      moves.push_back(nb::cast<const PlannedMove&>(one));
    }
  } else {
    refuse(msg::python_motions);
  }
  if (moves.empty()) refuse(msg::python_empty, "motion");
  constexpr double kJoined = 1e-6;  // [rad or m]
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const Trajectory& now = moves[i].trajectory;
    if (now.dof() != robot.dof()) refuse(msg::python_other_arm, now.dof(), robot.dof());
    if (moves[i].tool != 0) refuse(msg::python_other_tool, i);
    if (i == 0) continue;
    const Trajectory& before = moves[i - 1].trajectory;
    const JointVec gap = now.at(0).q - before.at(before.duration()).q;
    if (gap.cwiseAbs().maxCoeff() > kJoined) refuse(msg::python_gap, i);
  }
  return moves;
}

std::unique_ptr<BoundRun> simulate(const BoundRobot& robot, nb::handle motion,
                                   const std::string& control, double rest, double tolerance,
                                   const std::optional<Payload>& payload) {
  if (!(rest >= 0 && rest <= kMostRest)) refuse(msg::python_rest, kMostRest);
  if (!(tolerance > 0)) refuse(msg::python_positive, "tolerance");
  program::LoadedProgram loaded{.file = {}, .program = {}, .robot = robot.robot, .plan = {}};
  loaded.program.name = robot.arm().name;
  loaded.program.control = value_of(control_mode(control));
  loaded.plan.moves = moves_of(robot, motion);
  if (payload) {
    for (PlannedMove& move : loaded.plan.moves) move.payload = *payload;
  }
  loaded.plan.arms = {robot.arm()};
  loaded.plan.q_start = loaded.plan.moves.front().trajectory.at(0).q;
  return value_of(interruptible([&](const StopCheck& stop) {
    return BoundRun::execute(std::move(loaded), {.rest = rest, .tolerance = tolerance}, stop);
  }));
}

nb::object report_of(const BoundRun& run) {
  return nb::module_::import_("json").attr("loads")(to_json(run.report()));
}

/// Columns of the record by name, as log.csv has them.
nb::dict log_of(const BoundRun& run) {
  std::vector<double> time;
  std::vector<JointVec> q_ref, q, v, ctrl, torque;
  std::vector<double> pos, quat, pos_ref, quat_ref;
  std::vector<std::string> contacts;
  const auto add = [](const Pose& X, std::vector<double>& p, std::vector<double>& turn) {
    p.insert(p.end(), X.p.begin(), X.p.end());
    std::ranges::copy(quat_values(X), std::back_inserter(turn));
  };
  const std::size_t n = run.recorder().size();
  for (std::size_t i = 0; i < n; ++i) {
    RecordRow row = run.recorder().row(i);
    time.push_back(row.time);
    q_ref.push_back(row.q_ref);
    q.push_back(row.q);
    v.push_back(row.v);
    ctrl.push_back(row.ctrl);
    torque.push_back(row.torque);
    add(row.X_WT, pos, quat);
    add(row.X_ref, pos_ref, quat_ref);
    contacts.push_back(std::move(row.contacts));
  }
  nb::dict out;
  out["time"] = array(std::move(time), {n});
  out["q_ref"] = array(q_ref, run.dof());
  out["q"] = array(q, run.dof());
  out["v"] = array(v, run.dof());
  out["tool_ref_pos"] = array(std::move(pos_ref), {n, 3});
  out["tool_ref_quat"] = array(std::move(quat_ref), {n, 4});
  out["tool_pos"] = array(std::move(pos), {n, 3});
  out["tool_quat"] = array(std::move(quat), {n, 4});
  out["ctrl"] = array(ctrl, run.dof());
  out["torque"] = array(torque, run.dof());
  out["contacts"] = nb::cast(std::move(contacts));
  return out;
}

nb::object picture_of(const BoundRun& run, const std::optional<std::filesystem::path>& file,
                      int width, int height) {
  check_pixels(width, height);
  auto image = [&] {
    const nb::gil_scoped_release free;
    return run.picture(width, height);
  }();
  return give(value_of(std::move(image)), file);
}

void film(const BoundRun& run, const std::filesystem::path& file, int width, int height,
          double fps) {
  check_pixels(width, height);
  if (file.extension() != ".mp4") refuse(msg::python_extension, "file", ".mp4");
  if (!(fps > 0 && fps <= 240)) refuse(msg::python_fps);
  value_of(interruptible([&](const StopCheck& stop) {
    return run.film({.out = file, .video = true, .width = width, .height = height, .fps = fps},
                    stop);
  }));
}

std::string words_of(const BoundRun& run) {
  const Report& report = run.report();
  std::string out = "<mjarm.Run: " + report.name + ", " + report.control + ", " +
                    std::to_string(report.duration) + " s";
  if (report.path_error) out += ", path " + std::to_string(1e3 * report.path_error->max) + " mm";
  return out + (report.ok ? ", ok>" : ", " + report.reason + ">");
}

constexpr const char* kSimulate =
    R"(Executes motions in the simulation of the robot's file, by MuJoCo.

Parameters
----------
motion : Motion or sequence of Motion
    One after another; each begins where the one before ends.
control : str, optional
    "servo" (the actuators alone, as most scripts do), "servo_gravity", "feed_forward",
    "computed_torque", "joint_impedance", "tool_impedance" or "robust".
rest : float, optional
    How long the arm is held at the end [s].
tolerance : float, optional
    How far the tool may be from its curve and its goal [m] for the run to be `ok`.
payload : Payload, optional
    Hangs at the tool, and the controller knows it.

Returns
-------
Run
    Also of a run that went wrong: `ok` and `report` tell.
)";

}  // namespace

void bind_execution(nb::module_& m) {
  nb::class_<BoundRun>(m, "Run",
                       "What was executed in a simulation, with all that tells and shows it.")
      .def_prop_ro(
          "ok", [](const BoundRun& run) { return run.report().ok; },
          "Everything was done within its tolerance, and nothing touched that should not.")
      .def_prop_ro(
          "reason", [](const BoundRun& run) { return run.report().reason; },
          "Word of what is wrong, such as \"contact\"; empty where it is ok.")
      .def_prop_ro(
          "message", [](const BoundRun& run) { return run.report().detail; },
          "One line about it; empty where it is ok.")
      .def_prop_ro("report", &report_of, nb::sig("def report(self) -> dict[str, Any]"),
                   "What report.json of `mjarm run` holds.")
      .def_prop_ro(
          "log", &log_of, nb::sig("def log(self) -> dict[str, Any]"),
          "Every step by columns: time (n,) [s]; q_ref, q, v, ctrl, torque (n, dof); tool_pos, "
          "tool_ref_pos (n, 3) [m];\n"
          "tool_quat, tool_ref_quat (n, 4); contacts, \"geom|geom;...\" a row.")
      .def_prop_ro(
          "qpos",
          [](const BoundRun& run) {
            const auto qpos = run.qpos();
            return array(qpos, {qpos.size()});
          },
          nb::sig("def qpos(self) -> Array"),
          "How everything stands at its end, (nq,): for the pick or the look that follows.")
      .def(
          "plot",
          [](const BoundRun& run, const std::optional<std::filesystem::path>& file) {
            return give(run.plot(), file);
          },
          nb::arg("file") = nb::none(),
          nb::sig("def plot(self, file: str | os.PathLike[str] | None = None) -> bytes | None"),
          "Its page of charts: PNG as bytes, or written to a .png or .svg file.")
      .def(
          "picture", &picture_of, nb::arg("file") = nb::none(), nb::kw_only(),
          nb::arg("width") = 1280, nb::arg("height") = 720,
          nb::sig(
              "def picture(self, file: str | os.PathLike[str] | None = None, *, width: int = 1280, "
              "height: int = 720) -> bytes | None"),
          "Its end, with the planned and the executed path: PNG as bytes, or written to a file.")
      .def("video", &film, nb::arg("file"), nb::kw_only(), nb::arg("width") = 1280,
           nb::arg("height") = 720, nb::arg("fps") = 30.0,
           nb::sig("def video(self, file: str | os.PathLike[str], *, width: int = 1280, height: "
                   "int = 720, "
                   "fps: float = 30.0) -> None"),
           "Writes a video (.mp4, by ffmpeg); the run is simulated once more for it, to the same "
           "end.")
      .def(
          "save",
          [](const BoundRun& run, const std::filesystem::path& folder, bool overwrite) {
            value_of(run.save(folder, overwrite));
          },
          nb::arg("folder"), nb::kw_only(), nb::arg("overwrite") = false,
          nb::sig(
              "def save(self, folder: str | os.PathLike[str], *, overwrite: bool = False) -> None"),
          "Writes the files of `mjarm run`: report.json, log.csv, plot.png, plot.svg, picture.png.")
      .def("_repr_png_", [](const BoundRun& run) { return give(run.plot(), {}); })
      .def("__bool__", [](const BoundRun& run) { return run.report().ok; })
      .def("__repr__", &words_of);
  auto robot = nb::borrow<nb::class_<BoundRobot>>(m.attr("Robot"));
  robot.def("simulate", &simulate, nb::arg("motion"), nb::kw_only(),
            nb::arg("control") = "computed_torque", nb::arg("rest") = kRestAtEnd,
            nb::arg("tolerance") = BoundRun::Choice().tolerance,
            nb::arg("payload").none() = nb::none(),
            nb::sig("def simulate(self, motion: Motion | Sequence[Motion], *, control: str = "
                    "'computed_torque', rest: float = 0.5, tolerance: float = 0.0005, payload: "
                    "Payload | None = None) -> Run"),
            kSimulate);
}

}  // namespace mjarm::python
