#pragma once

#include <filesystem>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/program/program.hpp"

namespace mjarm::program {

/// Reads a motion program from YAML, as docs/programs.md describes it. Names of poses and postures
/// are put in; names of frames and of the robot stay names, as the robot is not loaded. Numbers may
/// carry units.
/// @param name  of the file, for messages.
/// @return an error `name:line:column: what`, with the nearest right word where one was expected.
[[nodiscard]] Result<Program> parse_program(const std::string& text, const std::string& name);

/// The same of a file of at most 16 MB.
[[nodiscard]] Result<Program> read_program(const std::filesystem::path& file);

}  // namespace mjarm::program
