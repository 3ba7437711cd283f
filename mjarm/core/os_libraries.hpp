#pragma once

#include <filesystem>
#include <string_view>

namespace mjarm {

/// File of the first shared library of this process whose name begins with `stem`, e.g. "mujoco" of
/// libmujoco.so or mujoco.dll; empty where there is none.
[[nodiscard]] std::filesystem::path loaded_library(std::string_view stem);

}  // namespace mjarm
