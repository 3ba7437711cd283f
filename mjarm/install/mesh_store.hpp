#pragma once

#include <filesystem>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/install/mesh_sets.hpp"

namespace mjarm::install {

/// `$XDG_DATA_HOME/mjarm`, else `~/.local/share/mjarm`: the one folder that mjarm writes to without
/// being told so. It need not exist.
[[nodiscard]] Result<std::filesystem::path> data_folder();

/// Where the meshes of `set` are, or would be; `scene.xml` and `assets` lie in it.
[[nodiscard]] std::filesystem::path mesh_folder(const std::filesystem::path& data,
                                                const MeshSet& set);

/// How installed meshes are found.
struct MeshState {
  enum class Kind {
    absent,
    damaged,   ///< files are missing or changed
    outdated,  ///< whole, but the scene around them is that of another version of mjarm
    whole,
  };
  Kind kind = Kind::absent;
  std::string problem;  ///< one line where damaged or outdated
};

/// Reads every file of `folder` and compares its hash.
/// @param scene  what `scene.xml` must say.
[[nodiscard]] MeshState check_meshes(const std::filesystem::path& folder, const MeshSet& set,
                                     const std::string& scene);

/// Takes the meshes of `set` away, with whatever an unfinished install left. Other files in the
/// data folder stay. @return whether there was anything.
[[nodiscard]] Result<bool> remove_meshes(const std::filesystem::path& data, const MeshSet& set);

}  // namespace mjarm::install
