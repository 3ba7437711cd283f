#include "apps/mjarm/learn/program_steps.hpp"

#include <variant>

namespace mjarm::app {
namespace {

void add_steps(const std::vector<program::Instruction>& instructions,
               std::vector<const program::Instruction*>& out) {
  for (const program::Instruction& instruction : instructions) {
    if (const auto* const loop = std::get_if<program::Repeat>(&instruction.what)) {
      add_steps(loop->body, out);
    } else {
      out.push_back(&instruction);
    }
  }
}

}  // namespace

std::vector<const program::Instruction*> steps_of(const program::Program& program) {
  std::vector<const program::Instruction*> out;
  add_steps(program.instructions, out);
  return out;
}

}  // namespace mjarm::app
