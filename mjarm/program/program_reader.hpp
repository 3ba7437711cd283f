#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mjarm/core/file_place.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/program/program.hpp"

namespace mjarm::program {

/// What is wrong with the text of a program, and where.
struct TextFault {
  FilePlace place;
  std::string what;  ///< one line for people, without the place
};

/// A text and all that is wrong with it.
struct ProgramText {
  Program program;                ///< what could be read; whole only where nothing is wrong
  std::vector<TextFault> faults;  ///< in the order of the text, 100 at most
};

/// Reads a motion program from YAML and goes on after faults, so that one run finds all of them,
/// with the nearest right word where one was expected. Text that is no YAML has one fault.
[[nodiscard]] ProgramText look_through(const std::string& text);
/// The same of a file of at most 16 MB.
/// @return bad_input where it cannot be read.
[[nodiscard]] Result<ProgramText> look_through_file(const std::filesystem::path& file);

/// Reads a motion program from YAML, as docs/programs.md describes it. Names of poses and postures
/// are put in; names of frames and of the robot stay names, as the robot is not loaded. Numbers may
/// carry units.
/// @param name  of the file, for messages.
/// @return an error `name:line:column: what` of the first fault, and how many more there are.
[[nodiscard]] Result<Program> parse_program(const std::string& text, const std::string& name);

/// The same of a file of at most 16 MB.
[[nodiscard]] Result<Program> read_program(const std::filesystem::path& file);

}  // namespace mjarm::program
