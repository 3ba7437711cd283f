#pragma once

#include <filesystem>

#include "mjarm/core/result.hpp"

namespace mjarm {

/// Where the files that are shipped lie: `../share/mjarm` from the folder of the program.
/// @return an error where the program's own place is unknown.
[[nodiscard]] Result<std::filesystem::path> share_folder();

}  // namespace mjarm
