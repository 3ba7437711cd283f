#include <stdexcept>

#include "tests/support/run_program.hpp"

namespace mjarm::support {

ProgramResult run_program(const std::filesystem::path& program, const std::vector<std::string>&,
                          const RunOptions&) {
  throw std::runtime_error(program.string() + ": tests start no programs on Windows so far");
}

}  // namespace mjarm::support
