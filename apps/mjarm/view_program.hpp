#pragma once

#include <string>

#include "apps/mjarm/view_show.hpp"

namespace mjarm::app {

/// True for a `.yaml` or `.yml` file, and for the name of a shipped program that is no model's.
[[nodiscard]] bool is_program(const std::string& name_or_path);

/// Plans a program and opens a window in which the user runs it.
/// @return the exit code, or the same error as `mjarm run`.
[[nodiscard]] Result<int> view_program(const std::string& name_or_path, WindowOptions window,
                                       const ShowOptions& options);

}  // namespace mjarm::app
