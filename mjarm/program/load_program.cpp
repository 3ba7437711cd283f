#include "mjarm/program/load_program.hpp"

#include <algorithm>
#include <vector>

#include "mjarm/core/messages/program.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/core/share.hpp"
#include "mjarm/core/yaml_tree.hpp"
#include "mjarm/program/program_reader.hpp"

namespace mjarm::program {

namespace {

/// Folder of the shipped programs; empty where the program's own place is unknown.
std::filesystem::path shipped_folder() {
  const Result<std::filesystem::path> share = share_folder();
  return share ? *share / "programs" : std::filesystem::path();
}

/// All that is wrong with a text that has faults.
std::vector<ProgramFault> text_faults(const std::filesystem::path& file, const ProgramText& text,
                                      const LoadOptions& load) {
  std::vector<ProgramFault> out;
  if (text.faults.empty()) return out;
  for (const TextFault& fault : text.faults) {
    out.push_back({fault.place, {}, "bad_input", fault.what, Errc::bad_input});
  }
  // What names a robot, tools and frames is right or wrong whatever else is wrong.
  if (text.program.robot.empty() && text.program.scene.empty()) return out;
  const auto robot = load_robot_of(text.program, file, load);
  std::vector<ProgramFault> more{};
  if (robot) {
    more = find_misfits(robot->model, robot->arm, text.program);
  } else {
    more.push_back(robot.error());
  }
  std::ranges::move(more, std::back_inserter(out));
  std::ranges::stable_sort(out, {}, &ProgramFault::place);
  return out;
}

/// The first of `faults`, and how many more there are.
Error first_of(const std::string& file, const std::vector<ProgramFault>& faults) {
  std::string line = line_of(file, faults.front());
  if (faults.size() > 1) line += text(msg::program_more, faults.size() - 1);
  return {faults.front().code, std::move(line)};
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

Result<std::vector<ProgramFault>> find_text_faults(const std::filesystem::path& file,
                                                   const LoadOptions& load) {
  const Result<ProgramText> read = look_through_file(file);
  if (!read) return fail(read.error());
  return text_faults(file, *read, load);
}

Result<LoadedProgram> load_program(const std::string& name_or_path, const StopCheck& stop,
                                   const LoadOptions& load, const SeeScene& see,
                                   const std::optional<Payload>& payload) {
  const Result<std::filesystem::path> found = find_program_file(name_or_path);
  if (!found) return fail(found.error());
  Result<ProgramText> read = look_through_file(*found);
  if (!read) return fail(std::move(read.error()));
  if (!read->faults.empty()) {
    return fail(first_of(found->string(), text_faults(*found, *read, load)));
  }
  Result<Robot> robot = load_program_robot(read->program, *found, load);
  if (!robot) return fail(std::move(robot.error()));
  if (payload) read->program.settings.payload = payload;
  return plan_loaded(found->string(), std::move(read->program), std::move(*robot), stop, see);
}

Result<LoadedProgram> load_sound_program(const std::string& name_or_path, const StopCheck& stop,
                                         const LoadOptions& load, const SeeScene& see,
                                         const std::optional<Payload>& payload) {
  Result<LoadedProgram> loaded = load_program(name_or_path, stop, load, see, payload);
  if (loaded && !loaded->plan.ok()) return fail(first_fault(*loaded));
  return loaded;
}

Result<LoadedProgram> plan_loaded(const std::string& file, Program program, Robot robot,
                                  const StopCheck& stop, const SeeScene& see) {
  std::optional<Progress> progress;
  std::size_t told = 0;
  const auto after_step = [&](std::size_t done, std::size_t total) {
    if (!progress) progress.emplace(text(msg::program_planning), total);
    progress->advance(done - told);
    told = done;
  };
  ProgramPlan plan = plan_program(robot.model, robot.arm, program,
                                  {.see = see, .after_step = after_step, .stop = stop});
  if (is_stopped(stop)) return fail(stopped());
  return LoadedProgram{file, std::move(program), std::move(robot), std::move(plan)};
}

std::string line_of(const LoadedProgram& loaded, const ProgramFault& fault) {
  return line_of(loaded.file, fault);
}

std::string line_of(const std::string& file, const ProgramFault& fault) {
  if (fault.word.empty()) return at_place(file, fault.place, fault.what);
  std::string place = file;
  if (fault.place.line > 0) {
    place += ":" + std::to_string(fault.place.line) + ":" + std::to_string(fault.place.column);
  }
  return text(msg::program_fault, place, fault.word, fault.what);
}

Error first_fault(const LoadedProgram& loaded) { return first_of(loaded.file, loaded.plan.faults); }

}  // namespace mjarm::program
