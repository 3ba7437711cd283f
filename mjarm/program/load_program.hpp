#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/program/program_plan.hpp"

namespace mjarm::program {

/// A program, what it runs on, and the plan of it.
struct LoadedProgram {
  std::string file;
  Program program;
  Robot robot;
  ProgramPlan plan;

  /// How it is run: as the program asks, else by computed torque.
  [[nodiscard]] ContactReaction contact() const {
    return program.contact.value_or(ContactReaction::ignore);
  }
  [[nodiscard]] ControlMode control() const {
    return program.control.value_or(ControlMode::computed_torque);
  }
};

/// File of a shipped program, by its name with or without `.yaml`.
/// @return an error with the nearest name.
[[nodiscard]] Result<std::filesystem::path> find_shipped_program(const std::string& name);

/// File of a program: a path, or the name of a shipped one, with or without `.yaml`.
/// @return an error with the nearest name.
[[nodiscard]] Result<std::filesystem::path> find_program_file(const std::string& name_or_path);

/// True for a `.yaml` or `.yml` file, and for the name of a shipped program that is no model's.
[[nodiscard]] bool is_program(const std::string& name_or_path);

/// All that is wrong with the text of a program, none where it can be planned: what cannot be read,
/// and the names and values that do not fit the robot, in the order of the text.
/// @return an error where the file cannot be read.
[[nodiscard]] Result<std::vector<ProgramFault>> find_text_faults(const std::filesystem::path& file,
                                                                 const LoadOptions& load = {});

/// Reads a program, loads its robot and plans it, with a progress bar. Of faults in the text the
/// error names the first.
/// @param stop  ends the planning with stopped(), as in the others.
/// @param load  how the robot's files are read.
/// @param see   does the instruction `look`.
/// @param payload  in place of the one at the top of the program.
[[nodiscard]] Result<LoadedProgram> load_program(const std::string& name_or_path,
                                                 const StopCheck& stop = {},
                                                 const LoadOptions& load = {},
                                                 const SeeScene& see = {},
                                                 const std::optional<Payload>& payload = {});

/// The same; a plan with faults is an error, the first of them.
[[nodiscard]] Result<LoadedProgram> load_sound_program(const std::string& name_or_path,
                                                       const StopCheck& stop = {},
                                                       const LoadOptions& load = {},
                                                       const SeeScene& see = {},
                                                       const std::optional<Payload>& payload = {});

/// Plans a program for a robot that is loaded already, with a progress bar.
/// @param file  for messages.
[[nodiscard]] Result<LoadedProgram> plan_loaded(const std::string& file, Program program,
                                                Robot robot, const StopCheck& stop = {},
                                                const SeeScene& see = {});

/// `file:line:column: movel: out of reach by ...`.
[[nodiscard]] std::string line_of(const LoadedProgram& loaded, const ProgramFault& fault);
/// The same for the name of a file.
[[nodiscard]] std::string line_of(const std::string& file, const ProgramFault& fault);

/// The first fault as an error, and how many more there are; of a plan with faults.
[[nodiscard]] Error first_fault(const LoadedProgram& loaded);

}  // namespace mjarm::program
