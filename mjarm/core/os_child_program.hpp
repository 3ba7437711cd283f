#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/os_child.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm {

/// What `run_in_child` is where a process cannot be copied: on Windows, and there alone. Runs
/// `program` with these arguments and bounds; `input` is its standard input, and what it prints is
/// its answer. It is done where it ends with exit code 0.
/// @return an error where it cannot be started.
[[nodiscard]] Result<ChildResult> run_child_program(const std::filesystem::path& program,
                                                    const std::vector<std::string>& arguments,
                                                    std::string_view input,
                                                    const ChildLimits& limits = {});

/// To be called first in such a program: when it crashes, no window asks what to do.
void crash_silently() noexcept;

}  // namespace mjarm
