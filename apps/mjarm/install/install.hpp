#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/mjarm/install/index_settings.hpp"
#include "apps/mjarm/install/mesh_sets.hpp"
#include "mjarm/core/os_lock.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::app {

/// Where meshes may come from.
struct MeshSources {
  std::string archives;  ///< address of the folder of Menagerie's archives; empty = not asked
  IndexSettings index;   ///< package index with the wheel, asked where the archives fail
  /// Address of a folder with the archives or the wheel in it; not empty = nothing else is asked.
  std::string from;
};

/// The sources of this machine: the archives of Menagerie's releases (or of MENAGERIE_BASE_URL),
/// else the wheel of the package index that pip uses.
[[nodiscard]] MeshSources default_sources();

/// Waits until no other process installs, and makes the folder where it is missing.
[[nodiscard]] Result<FolderLock> lock_data_folder(const std::filesystem::path& data);

/// Fetches the meshes of `set` into `data` and puts `scene` beside them as `scene.xml`. Everything
/// is verified before it appears under its name. May be ended at any moment: the next call goes on
/// with what was fetched. The caller holds the lock of `data`. Archives that could not be had are
/// struck from `sources`, so that the next robot does not wait for them again.
[[nodiscard]] Result<void> install_meshes(const std::filesystem::path& data, const MeshSet& set,
                                          const std::string& scene, MeshSources& sources);

}  // namespace mjarm::app
