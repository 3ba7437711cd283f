#pragma once

#include <string>
#include <vector>

#include "mjarm/core/json_writer.hpp"
#include "mjarm/program/load_program.hpp"

namespace mjarm::app {

/// A table of the motions, what slows the tool down, and the faults, for people.
[[nodiscard]] std::string plan_text(const program::LoadedProgram& loaded);
/// The same as one document.
[[nodiscard]] JsonDoc plan_json(const program::LoadedProgram& loaded);

/// Faults of a text that cannot be planned, a line each.
[[nodiscard]] std::string faults_text(const std::string& file,
                                      const std::vector<program::ProgramFault>& faults);
/// The same as one document.
[[nodiscard]] JsonDoc faults_json(const std::vector<program::ProgramFault>& faults);

}  // namespace mjarm::app
