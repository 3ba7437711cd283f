#pragma once

#include <string>
#include <vector>

namespace mjarm {

/// Opens what is closed of standard input, output and error on the null device. A file that is
/// opened later would take the free number otherwise, and every message would go into it. To be
/// called first of all in a program. On Windows the streams pass bytes on as they are, and a
/// console shows UTF-8.
void open_standard_streams() noexcept;

/// What the program was called with, in UTF-8, without its own name.
[[nodiscard]] std::vector<std::string> program_arguments(int argc, const char* const* argv);

}  // namespace mjarm
