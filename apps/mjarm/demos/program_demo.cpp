#include "apps/mjarm/demos/program_demo.hpp"

#include <utility>

#include "apps/mjarm/commands/program_run.hpp"
#include "apps/mjarm/demos/demo_stage.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/program/program_reader.hpp"

namespace mjarm::app {

Result<program::Program> demo_program(const std::string& demo) {
  // Not a file of that name in the working directory.
  return program::find_shipped_program(demo).and_then(
      [](const std::filesystem::path& file) { return program::read_program(file); });
}

Result<program::LoadedProgram> plan_demo(program::Program program, const DemoOptions& options,
                                         const ProgramEdit& edit) {
  const std::string& seed = options.values.seed_q;
  const bool own = options.values.of_geometry();
  const std::size_t dof = program.start.values.size();
  const bool any = own || !seed.empty();
  Result<Robot> robot = load_demo_robot(program.name, options, any ? 0 : static_cast<int>(dof));
  if (!robot) return fail(std::move(robot.error()));
  // On its way to a goal of the user's another arm starts at home.
  if (robot->arm.dof() != static_cast<int>(dof)) program.start = {};
  if (!seed.empty()) {
    Result<std::vector<double>> q = read_posture("--seed-q", seed, robot->arm);
    if (!q) return fail(std::move(q.error()));
    program.start = {.values = std::move(*q)};
  }
  if (edit) {
    if (Result<void> edited = edit(program, robot->arm); !edited) return fail(edited.error());
  }
  if (options.control) program.control = options.control;
  // What the user wants stands on no line of the program.
  for (program::Instruction& instruction : program.instructions) {
    if (own) instruction.place = {};
  }
  const std::string file = own ? "demo " + program.name : program.name + ".yaml";
  return program::plan_loaded(file, std::move(program), std::move(*robot), interrupted);
}

Result<Report> run_demo_plan(const program::LoadedProgram& loaded, const DemoOptions& options) {
  constexpr double kTolerance = 5e-4;  // [m]
  if (loaded.plan.ok()) return run_and_show(loaded, options, kTolerance);
  const Result<std::unique_ptr<session::Stage>> stage =
      session::Stage::open(loaded.program.name, options, loaded.robot);
  if (!stage) return fail(stage.error());
  return (*stage)->refuse(loaded.plan.faults.front().reason, program::first_fault(loaded).what);
}

Result<Report> run_program_demo(const std::string& demo, const DemoOptions& options,
                                const ProgramEdit& edit) {
  Result<program::Program> program = demo_program(demo);
  if (!program) return fail(std::move(program.error()));
  const Result<program::LoadedProgram> loaded = plan_demo(std::move(*program), options, edit);
  if (!loaded) return fail(loaded.error());
  return run_demo_plan(*loaded, options);
}

}  // namespace mjarm::app
