#pragma once

namespace mjarm {

/// Opens what is closed of standard input, output and error on the null device. A file that is
/// opened later would take the free number otherwise, and every message would go into it. To be
/// called first of all in a program.
void open_standard_streams() noexcept;

}  // namespace mjarm
