#pragma once

#include <string>
#include <vector>

#include "tests/support/run_program.hpp"

namespace mjarm::app {

#ifdef MJARM_MPIRUN
/// Runs `mjarm` in so many processes on this machine.
inline support::ProgramResult in_processes(int count, const std::vector<std::string>& arguments) {
  std::vector<std::string> all = {
      "--allow-run-as-root", "--oversubscribe", "--bind-to", "none", "-n",
      std::to_string(count), MJARM_PROGRAM};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return support::run_program(MJARM_MPIRUN, all);
}

#endif

}  // namespace mjarm::app
