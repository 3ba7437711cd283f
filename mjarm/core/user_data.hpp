#pragma once

#include <filesystem>

#include "mjarm/core/result.hpp"

namespace mjarm {

/// `$XDG_DATA_HOME/mjarm`, else `~/.local/share/mjarm`: the one folder that mjarm writes to without
/// being told so, by `mjarm models install`. It need not exist.
[[nodiscard]] Result<std::filesystem::path> data_folder();

}  // namespace mjarm
