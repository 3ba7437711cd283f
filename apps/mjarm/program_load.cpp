#include "apps/mjarm/program_load.hpp"

#include "mjarm/core/messages/motion_program.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/program/program_reader.hpp"

namespace mjarm::app {

Result<LoadedProgram> load_program(const std::string& file) {
  Result<Program> program = read_program(file);
  if (!program) return fail(std::move(program.error()));
  Result<ProgramRobot> robot = load_program_robot(*program, file);
  if (!robot) return fail(std::move(robot.error()));
  std::optional<Progress> progress;
  std::size_t told = 0;
  const auto after_step = [&](std::size_t done, std::size_t total) {
    if (!progress) progress.emplace(text(msg::motion_program_planning), total);
    progress->advance(done - told);
    told = done;
    return !interrupted();
  };
  ProgramPlan plan = plan_program(robot->model, robot->arm, *program, {.after_step = after_step});
  if (interrupted()) return fail(Errc::impossible, text(msg::motion_program_stopped));
  return LoadedProgram{file, std::move(*program), std::move(*robot), std::move(plan)};
}

std::string line_of(const LoadedProgram& loaded, const ProgramFault& fault) {
  std::string place = loaded.file;
  if (fault.place.line > 0) {
    place += ":" + std::to_string(fault.place.line) + ":" + std::to_string(fault.place.column);
  }
  return text(msg::motion_program_fault, place, fault.word, fault.what);
}

Error first_fault(const LoadedProgram& loaded) {
  const std::vector<ProgramFault>& faults = loaded.plan.faults;
  std::string line = line_of(loaded, faults.front());
  if (faults.size() > 1) line += text(msg::motion_program_more, faults.size() - 1);
  return {faults.front().code, std::move(line)};
}

}  // namespace mjarm::app
