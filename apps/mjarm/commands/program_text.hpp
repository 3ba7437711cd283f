#pragma once

#include <string>

#include "mjarm/core/json_writer.hpp"
#include "mjarm/program/load_program.hpp"

namespace mjarm::app {

/// A table of the motions, what slows the tool down, and the faults, for people.
[[nodiscard]] std::string plan_text(const program::LoadedProgram& loaded);
/// The same as one document.
[[nodiscard]] JsonDoc plan_json(const program::LoadedProgram& loaded);

}  // namespace mjarm::app
