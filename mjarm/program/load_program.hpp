#pragma once

#include <filesystem>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/program/program_plan.hpp"

namespace mjarm::program {

/// A program, what it runs on, and the plan of it.
struct LoadedProgram {
  std::string file;
  Program program;
  Robot robot;
  ProgramPlan plan;

  /// How it is run: as the program asks, else by computed torque.
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

/// Reads a program, loads its robot and plans it, with a progress bar.
[[nodiscard]] Result<LoadedProgram> load_program(const std::string& name_or_path);

/// The same; a plan with faults is an error, the first of them.
[[nodiscard]] Result<LoadedProgram> load_sound_program(const std::string& name_or_path);

/// Plans a program for a robot that is loaded already, with a progress bar.
/// @param file  for messages.
[[nodiscard]] Result<LoadedProgram> plan_loaded(const std::string& file, Program program,
                                                Robot robot);

/// `file:line:column: movel: out of reach by ...`.
[[nodiscard]] std::string line_of(const LoadedProgram& loaded, const ProgramFault& fault);

/// The first fault as an error, and how many more there are; of a plan with faults.
[[nodiscard]] Error first_fault(const LoadedProgram& loaded);

}  // namespace mjarm::program
