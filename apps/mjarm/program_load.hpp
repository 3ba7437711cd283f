#pragma once

#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/program/program_plan.hpp"

namespace mjarm::app {

/// A program, what it runs on, and the plan of it.
struct LoadedProgram {
  std::string file;
  Program program;
  ProgramRobot robot;
  ProgramPlan plan;
};

/// Reads a program, loads its robot and plans it, with a progress bar.
[[nodiscard]] Result<LoadedProgram> load_program(const std::string& file);

/// `file:line:column: movel: out of reach by ...`.
[[nodiscard]] std::string line_of(const LoadedProgram& loaded, const ProgramFault& fault);

/// The first fault as an error, and how many more there are; of a plan with faults.
[[nodiscard]] Error first_fault(const LoadedProgram& loaded);

}  // namespace mjarm::app
