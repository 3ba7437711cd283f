#pragma once

#include <filesystem>
#include <string>

#include "mjarm/core/os_lock.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/install/index_settings.hpp"
#include "mjarm/install/mesh_sets.hpp"

namespace mjarm::install {

/// Waits until no other process installs, and makes the folder where it is missing.
[[nodiscard]] Result<FolderLock> lock_data_folder(const std::filesystem::path& data);

/// Fetches the meshes of `set` into `data` and puts `scene` beside them as `scene.xml`. Everything
/// is verified before it appears under its name. May be ended at any moment: the next call goes on
/// with what was fetched. The caller holds the lock of `data`.
/// @param from  address of a folder with the wheel in it; empty = the package index is asked.
[[nodiscard]] Result<void> install_meshes(const std::filesystem::path& data, const MeshSet& set,
                                          const std::string& scene, const IndexSettings& index,
                                          const std::string& from);

}  // namespace mjarm::install
