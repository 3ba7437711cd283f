#pragma once

#include <filesystem>
#include <vector>

#include "mjarm/core/result.hpp"

namespace mjarm {

/// Where the files that are shipped may lie, in the order of search: `../share/mjarm` from the
/// folder of the program; where mjarm is part of a library (a module of Python), `share/mjarm` in
/// the folder of that; and the share folder of the installation whose MuJoCo this process runs
/// with. The last is how somebody else's program, into which mjarm is linked, finds the models of
/// the installation that it was built against, wherever that was moved to.
[[nodiscard]] std::vector<std::filesystem::path> share_folders();

/// The first of `share_folders()` that exists, else the first.
/// @return an error where the program's own place is unknown.
[[nodiscard]] Result<std::filesystem::path> share_folder();

}  // namespace mjarm
