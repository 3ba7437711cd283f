#include "apps/mjarm/install/mesh_sets.hpp"

#include <string_view>

namespace mjarm::app {
namespace {

struct Row {
  std::string_view robot;
  MeshFile file;
};

std::vector<MeshFile> files_of(std::string_view robot) {
  static const Row rows[] = {
#define MJARM_MESH(robot, name, size, offset, packed, sha256) \
  {#robot, {name, size, offset, packed, sha256}},
#include "apps/mjarm/install/mesh_files.inc"
#undef MJARM_MESH
  };
  std::vector<MeshFile> files;
  for (const Row& row : rows) {
    if (row.robot == robot) files.push_back(row.file);
  }
  return files;
}

}  // namespace

std::span<const MeshSet> mesh_sets() {
  // The archives as the Python package mujoco-menagerie 2026.10.4 lists them.
  static const RemoteFile wheel = {
      "genesis_world-1.4.5-py3-none-any.whl", 83622446,
      "7ce8fcc8b0af9a87907e550b5f373b27af3f6ca622e843ce12dc51e8a93a03fd"};
  static const MeshSet sets[] = {
      {"ur5e",
       "universal_robots_ur5e",
       "BSD-3-Clause",
       {"universal_robots_ur5e-2a3464301404aba7.tar.xz", 2640784,
        "dfecee8c3a53b2a447fdec5e253d9b6cb7fcc9843b3d424cbbb9462774e36652"},
       wheel,
       "genesis-world",
       files_of("ur5e")},
      {"panda",
       "franka_emika_panda",
       "Apache-2.0",
       {"franka_emika_panda-3d2262eeb81ecec1.tar.xz", 3088140,
        "d27e1c3e7c7cc161e81a1c12f2805d64676d7514d9069fe211cb1827fbae97e8"},
       wheel,
       "genesis-world",
       files_of("panda")},
  };
  return sets;
}

}  // namespace mjarm::app
