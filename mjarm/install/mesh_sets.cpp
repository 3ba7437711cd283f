#include "mjarm/install/mesh_sets.hpp"

#include <string_view>

namespace mjarm::install {
namespace {

struct Row {
  std::string_view robot;
  MeshFile file;
};

std::vector<MeshFile> files_of(std::string_view robot) {
  static const Row rows[] = {
#define MJARM_MESH(robot, name, size, offset, packed, sha256) \
  {#robot, {name, size, offset, packed, sha256}},
#include "mjarm/install/mesh_files.inc"
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
  const auto set = [](const char* robot, const char* folder, const char* licence) -> MeshSet {
    return {robot,
            folder,
            licence,
            "genesis-world",
            "genesis_world-1.4.5-py3-none-any.whl",
            "7ce8fcc8b0af9a87907e550b5f373b27af3f6ca622e843ce12dc51e8a93a03fd",
            files_of(robot)};
  };
  static const MeshSet sets[] = {set("ur5e", "universal_robots_ur5e", "BSD-3-Clause"),
                                 set("panda", "franka_emika_panda", "Apache-2.0")};
  return sets;
}

}  // namespace mjarm::install
