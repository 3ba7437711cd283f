#pragma once

#include <vector>

#include "mjarm/program/program.hpp"

namespace mjarm::app {

/// The instructions of a program in the order of its text, those of loops once; they live as long
/// as the program.
[[nodiscard]] std::vector<const program::Instruction*> steps_of(const program::Program& program);

}  // namespace mjarm::app
