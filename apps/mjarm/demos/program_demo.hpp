#pragma once

#include <string>

#include "apps/mjarm/demos/demos.hpp"
#include "mjarm/program/load_program.hpp"

namespace mjarm::app {

/// The shipped program of a demo.
[[nodiscard]] Result<program::Program> demo_program(const std::string& demo);

/// Plans `program` on the robot that the user chose.
/// @return usage where the program's postures are for another number of joints.
[[nodiscard]] Result<program::LoadedProgram> plan_demo(program::Program program,
                                                       const DemoOptions& options);

/// Runs and shows it; a plan with faults ends the demo with the first of them.
[[nodiscard]] Result<Report> run_demo_plan(const program::LoadedProgram& loaded,
                                           const DemoOptions& options);

/// All of that: the demo is its program.
[[nodiscard]] Result<Report> run_program_demo(const std::string& demo, const DemoOptions& options);

}  // namespace mjarm::app
