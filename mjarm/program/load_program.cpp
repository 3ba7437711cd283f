#include "mjarm/program/load_program.hpp"

#include <algorithm>
#include <vector>

#include "mjarm/core/messages/program.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/core/share.hpp"
#include "mjarm/program/program_reader.hpp"

namespace mjarm::program {

namespace {

/// Folder of the shipped programs; empty where the program's own place is unknown.
std::filesystem::path shipped_folder() {
  const Result<std::filesystem::path> share = share_folder();
  return share ? *share / "programs" : std::filesystem::path();
}

}  // namespace

Result<std::filesystem::path> find_program_file(const std::string& name_or_path) {
  std::error_code code;
  if (std::filesystem::exists(name_or_path, code)) return name_or_path;
  return find_shipped_program(name_or_path);
}

Result<std::filesystem::path> find_shipped_program(const std::string& name) {
  std::error_code code;
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(shipped_folder(), code)) {
    if (entry.path().extension() != ".yaml") continue;
    names.push_back(entry.path().stem().string());
    if (names.back() == name || entry.path().filename() == name) return entry.path();
  }
  std::ranges::sort(names);
  return fail(Errc::bad_input, text(msg::program_no_file, name) + did_you_mean(name, names));
}

bool is_program(const std::string& name_or_path) {
  const std::filesystem::path extension = std::filesystem::path(name_or_path).extension();
  if (extension == ".yaml" || extension == ".yml") return true;
  return !find_model_file(name_or_path) && find_program_file(name_or_path).has_value();
}

Result<LoadedProgram> load_program(const std::string& name_or_path) {
  const Result<std::filesystem::path> found = find_program_file(name_or_path);
  if (!found) return fail(found.error());
  Result<Program> program = read_program(*found);
  if (!program) return fail(std::move(program.error()));
  Result<Robot> robot = load_program_robot(*program, *found);
  if (!robot) return fail(std::move(robot.error()));
  return plan_loaded(found->string(), std::move(*program), std::move(*robot));
}

Result<LoadedProgram> load_sound_program(const std::string& name_or_path) {
  Result<LoadedProgram> loaded = load_program(name_or_path);
  if (loaded && !loaded->plan.ok()) return fail(first_fault(*loaded));
  return loaded;
}

Result<LoadedProgram> plan_loaded(const std::string& file, Program program, Robot robot) {
  std::optional<Progress> progress;
  std::size_t told = 0;
  const auto after_step = [&](std::size_t done, std::size_t total) {
    if (!progress) progress.emplace(text(msg::program_planning), total);
    progress->advance(done - told);
    told = done;
    return !interrupted();
  };
  ProgramPlan plan = plan_program(robot.model, robot.arm, program, {.after_step = after_step});
  if (interrupted()) return fail(Errc::impossible, text(msg::program_stopped));
  return LoadedProgram{file, std::move(program), std::move(robot), std::move(plan)};
}

std::string line_of(const LoadedProgram& loaded, const ProgramFault& fault) {
  std::string place = loaded.file;
  if (fault.place.line > 0) {
    place += ":" + std::to_string(fault.place.line) + ":" + std::to_string(fault.place.column);
  }
  return text(msg::program_fault, place, fault.word, fault.what);
}

Error first_fault(const LoadedProgram& loaded) {
  const std::vector<ProgramFault>& faults = loaded.plan.faults;
  std::string line = line_of(loaded, faults.front());
  if (faults.size() > 1) line += text(msg::program_more, faults.size() - 1);
  return {faults.front().code, std::move(line)};
}

}  // namespace mjarm::program
