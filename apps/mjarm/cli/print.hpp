#pragma once

#include <string_view>

namespace mjarm::app {

/// Writes lines, or a document of JSON, to standard output; what a terminal would obey of names
/// that come from files is shown instead (`printable`).
void print_lines(std::string_view lines);

}  // namespace mjarm::app
