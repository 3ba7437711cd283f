// Motion programs: files of instructions, planned as a whole.
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <utility>

#include "mjarm/program/load_program.hpp"
#include "mjarm/program/program_reader.hpp"
#include "mjarm/program/urscript.hpp"
#include "mjarm/session/see_scene.hpp"
#include "python/src/bindings.hpp"
#include "python/src/convert.hpp"
#include "python/src/interrupt.hpp"
#include "python/src/robot.hpp"
#include "python/src/run.hpp"

namespace mjarm::python {
namespace {

namespace fs = std::filesystem;
using program::LoadedProgram;
using program::Program;
using program::ProgramFault;

/// `mjarm.Program`: the text, and the robot it is for.
struct BoundProgram {
  std::string file;
  Program program;
  Robot robot;
};

LoadOptions load_options(bool allow_outside, const std::vector<fs::path>& packages) {
  return {.package_paths = packages, .allow_outside = allow_outside};
}

BoundProgram with_robot(std::string file, Program program, const LoadOptions& load) {
  Robot robot = value_of([&] {
    const nb::gil_scoped_release free;
    return program::load_program_robot(program, file, load);
  }());
  return {std::move(file), std::move(program), std::move(robot)};
}

BoundProgram load_program(nb::handle name_or_path, bool allow_outside,
                          const std::vector<fs::path>& packages) {
  const std::string name = path_text(name_or_path);
  const fs::path file = value_of(program::find_program_file(name));
  return with_robot(file.string(), value_of(program::read_program(file)),
                    load_options(allow_outside, packages));
}

BoundProgram parse_program(const std::string& text, const fs::path& folder, bool allow_outside,
                           const std::vector<fs::path>& packages) {
  const fs::path file = folder / "program";
  Program program = value_of(program::parse_program(text, "program"));
  program.name = "program";
  return with_robot(file.string(), std::move(program), load_options(allow_outside, packages));
}

LoadedProgram think_through(const BoundProgram& self, const std::optional<Payload>& payload) {
  Program program = self.program;
  if (payload) program.settings.payload = payload;
  return value_of(interruptible([&](const StopCheck& stop) {
    return program::plan_loaded(self.file, std::move(program), self.robot, stop,
                                session::see_scene);
  }));
}

LoadedProgram sound(LoadedProgram loaded) {
  if (!loaded.plan.ok()) raise(program::first_fault(loaded));
  return loaded;
}

std::unique_ptr<BoundRun> execute(LoadedProgram loaded, const std::optional<std::string>& control,
                                  double rest, double tolerance, double max_duration) {
  if (!(rest >= 0)) refuse(msg::python_not_negative, "rest");
  if (!(tolerance > 0)) refuse(msg::python_positive, "tolerance");
  loaded = sound(std::move(loaded));
  const double duration = loaded.plan.duration() + rest;
  if (!(duration <= max_duration)) refuse(msg::python_too_long, duration, max_duration);
  if (control) loaded.program.control = value_of(control_mode(*control));
  return value_of(interruptible([&](const StopCheck& stop) {
    return BoundRun::execute(std::move(loaded), {.rest = rest, .tolerance = tolerance}, stop);
  }));
}

std::string urscript(const LoadedProgram& loaded) {
  return value_of(
      program::to_urscript(loaded.program, loaded.robot, loaded.plan, {.version = MJARM_VERSION}));
}

void bind_fault(nb::module_& m) {
  nb::class_<program::Detour>(m, "Detour", "A way round what blocks a move: tried, and free.")
      .def_ro("edges", &program::Detour::edges, "Straight pieces in joint space.")
      .def_ro("duration", &program::Detour::duration, "[s]")
      .def_ro("clearance", &program::Detour::clearance, "The least distance to anything [m].");
  nb::class_<ProgramFault>(m, "ProgramFault",
                           "What of a program cannot be done, and where it stands.")
      .def_prop_ro(
          "line", [](const ProgramFault& fault) { return fault.place.line; },
          "From 1; 0: of no file.")
      .def_prop_ro(
          "column", [](const ProgramFault& fault) { return fault.place.column; }, "From 1.")
      .def_ro("word", &ProgramFault::word, "The instruction.")
      .def_ro("reason", &ProgramFault::reason, "Word, such as \"out_of_reach\" or \"collision\".")
      .def_ro("message", &ProgramFault::what, "One line, without the place.")
      .def_ro("fix", &ProgramFault::fix, "A change with which all of a tool move was solved.")
      .def_ro("detour", &ProgramFault::detour, "What `plan` would do in place of a blocked move.")
      .def(
          "__str__",
          [](const ProgramFault& fault) { return program::line_of(std::string("program"), fault); })
      .def("__repr__", [](const ProgramFault& fault) {
        return "<mjarm.ProgramFault: " + program::line_of(std::string("program"), fault) + ">";
      });
}

void bind_program_plan(nb::module_& m) {
  nb::class_<LoadedProgram>(m, "ProgramPlan",
                            "A program that was thought through, before anything moves.")
      .def_prop_ro(
          "ok", [](const LoadedProgram& p) { return p.plan.ok(); },
          "It may run: there are no faults.")
      .def_prop_ro(
          "faults", [](const LoadedProgram& p) { return p.plan.faults; },
          "All that cannot be done, in the order of the program.")
      .def_prop_ro(
          "motions", [](const LoadedProgram& p) { return p.plan.moves; },
          "Its motions, one after another.")
      .def_prop_ro(
          "duration", [](const LoadedProgram& p) { return p.plan.duration(); },
          "Of all motions [s].")
      .def(
          "run",
          [](const LoadedProgram& p, const std::optional<std::string>& control, double rest,
             double tolerance,
             double max_duration) { return execute(p, control, rest, tolerance, max_duration); },
          nb::kw_only(), nb::arg("control") = nb::none(), nb::arg("rest") = kRestAtEnd,
          nb::arg("tolerance") = BoundRun::Choice().tolerance, nb::arg("max_duration") = 3600.0,
          "As Program.run(), without planning again.")
      .def(
          "urscript", [](const LoadedProgram& p) { return urscript(sound(p)); },
          "As a script for a controller of Universal Robots.")
      .def("__bool__", [](const LoadedProgram& p) { return p.plan.ok(); })
      .def("__len__", [](const LoadedProgram& p) { return p.plan.moves.size(); })
      .def("__repr__", [](const LoadedProgram& p) {
        const program::ProgramPlan& plan = p.plan;
        return "<mjarm.ProgramPlan: " + std::to_string(plan.moves.size()) + " motions, " +
               std::to_string(plan.duration()) + " s, " + std::to_string(plan.faults.size()) +
               " faults>";
      });
}

constexpr const char* kRunProgram = R"(Plans the program and executes it in a simulation.

Parameters
----------
control : str, optional
    As Robot.simulate() has it; by default as the program asks, else computed torque.
rest, tolerance : float, optional
    As Robot.simulate() has them.
max_duration : float, optional
    A program that takes longer is refused [s].
payload : Payload, optional
    Hangs at the tool from the beginning, in place of that of the program.

Raises
------
Impossible
    The first fault, with file and line, and how many more there are; check() lists them.
)";

}  // namespace

void bind_program(nb::module_& m) {
  bind_fault(m);
  bind_program_plan(m);
  nb::class_<BoundProgram>(m, "Program",
                           "A motion program, as docs/programs.md describes them, and its robot.")
      .def_static(
          "load", &load_program, nb::arg("name_or_path"), nb::kw_only(),
          nb::arg("allow_outside") = false, nb::arg("packages") = std::vector<fs::path>(),
          nb::sig("def load(name_or_path: str | os.PathLike[str], *, allow_outside: bool = False, "
                  "packages: Sequence[str | os.PathLike[str]] = ()) -> Program"),
          "Reads a YAML file, or a program that comes with mjarm, and loads its robot.\n"
          "\nRaises BadInput with file, line and column of the first fault.")
      .def_static(
          "parse", &parse_program, nb::arg("text"), nb::kw_only(),
          nb::arg("folder") = fs::path("."), nb::arg("allow_outside") = false,
          nb::arg("packages") = std::vector<fs::path>(),
          nb::sig(
              "def parse(text: str, *, folder: str | os.PathLike[str] = '.', allow_outside: bool = "
              "False, packages: Sequence[str | os.PathLike[str]] = ()) -> Program"),
          "The same of a text; paths in it start from `folder`.")
      .def_prop_ro(
          "name", [](const BoundProgram& p) { return p.program.name; }, "Of its file.")
      .def_prop_ro(
          "robot", [](const BoundProgram& p) { return BoundRobot(p.robot); },
          "The robot it is for, in its scene.")
      .def(
          "check", &think_through, nb::kw_only(), nb::arg("payload").none() = nb::none(),
          "Plans all of it, and finds all that cannot be done. Where the program looks, the camera "
          "is drawn.")
      .def(
          "run",
          [](const BoundProgram& p, const std::optional<std::string>& control, double rest,
             double tolerance, double max_duration, const std::optional<Payload>& payload) {
            return execute(think_through(p, payload), control, rest, tolerance, max_duration);
          },
          nb::kw_only(), nb::arg("control") = nb::none(), nb::arg("rest") = kRestAtEnd,
          nb::arg("tolerance") = BoundRun::Choice().tolerance, nb::arg("max_duration") = 3600.0,
          nb::arg("payload").none() = nb::none(), kRunProgram)
      .def(
          "urscript", [](const BoundProgram& p) { return urscript(sound(think_through(p, {}))); },
          "As a script for a controller of Universal Robots.")
      .def("__len__", [](const BoundProgram& p) { return p.program.instructions.size(); })
      .def("__repr__", [](const BoundProgram& p) {
        return "<mjarm.Program '" + p.program.name + "', " +
               std::to_string(p.program.instructions.size()) + " instructions for '" +
               p.robot.arm.name + "'>";
      });
}

}  // namespace mjarm::python
