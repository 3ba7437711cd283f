#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mjarm::install {

/// One mesh, and where its bytes lie (deflated) in the wheel.
struct MeshFile {
  std::string name;
  std::uint64_t size = 0;    ///< [bytes]
  std::uint64_t offset = 0;  ///< in the wheel
  std::uint64_t packed = 0;  ///< [bytes] in the wheel
  std::string sha256;        ///< of the file itself
};

/// All meshes of one robot, and the Python package (a wheel) that carries them.
struct MeshSet {
  std::string robot;   ///< what a user calls it
  std::string folder;  ///< of the shipped model, and where the meshes are kept
  std::string licence;
  std::string project;       ///< the name of the package in the index
  std::string wheel;         ///< its file
  std::string wheel_sha256;  ///< of all of it
  std::vector<MeshFile> files;
};

/// The robots whose meshes are known.
[[nodiscard]] std::span<const MeshSet> mesh_sets();

}  // namespace mjarm::install
