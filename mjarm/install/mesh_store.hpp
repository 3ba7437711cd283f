#pragma once

#include <filesystem>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/install/install_state.hpp"
#include "mjarm/install/mesh_sets.hpp"

namespace mjarm::install {

/// Where the meshes of `set` are, or would be; `scene.xml` and `assets` lie in it.
[[nodiscard]] std::filesystem::path mesh_folder(const std::filesystem::path& data,
                                                const MeshSet& set);

/// Reads every file of `folder` and compares its hash.
/// @param scene  what `scene.xml` must say.
[[nodiscard]] InstallState check_meshes(const std::filesystem::path& folder, const MeshSet& set,
                                        const std::string& scene);

/// Takes the meshes of `set` away, with whatever an unfinished install left. Other files in the
/// data folder stay. @return whether there was anything.
[[nodiscard]] Result<bool> remove_meshes(const std::filesystem::path& data, const MeshSet& set);

}  // namespace mjarm::install
