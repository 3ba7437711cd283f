#pragma once

#include <string>
#include <vector>

namespace mjarm::app {

/// Runs the command line `arguments` (without the name of the program).
/// @return the exit code: 0 done, 1 well-formed but cannot be done, 2 bad input or usage.
[[nodiscard]] int run(const std::vector<std::string>& arguments);

}  // namespace mjarm::app
