#pragma once

#include <filesystem>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/install/mesh_sets.hpp"
#include "mjarm/install/mesh_store.hpp"

namespace mjarm::install {

/// The meshes of one robot on this machine.
struct Installed {
  std::filesystem::path data;    ///< data folder of mjarm
  std::filesystem::path folder;  ///< of these meshes
  std::string scene;             ///< what `scene.xml` in it must say
  InstallState state;
};

/// Looks at every file. @return an error where the shipped model cannot be found or read.
[[nodiscard]] Result<Installed> look_up(const MeshSet& set);

/// The meshes a user names, e.g. "ur5e". @return a usage error with the nearest known name.
[[nodiscard]] Result<const MeshSet*> find_mesh_set(const std::string& robot);

/// The scene of `robot` with its real meshes, verified.
/// @return an error that says how to get them where they are missing or damaged.
[[nodiscard]] Result<std::filesystem::path> find_mesh_scene(const std::string& robot);

}  // namespace mjarm::install
