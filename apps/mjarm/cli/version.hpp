#pragma once

#include <string>

namespace mjarm::app {

/// "g++ 12.2.0": what compiled this program.
[[nodiscard]] std::string compiler();

/// "mjarm 0.1.0 (MuJoCo 4.0.1, g++ 12.2.0, avx512)": of this program, the library it runs with and
/// the instructions it uses here.
[[nodiscard]] std::string version_line();

}  // namespace mjarm::app
