#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mjarm::app {

/// One mesh, and where its bytes lie (deflated) in the wheel.
struct MeshFile {
  std::string name;
  std::uint64_t size = 0;    ///< [bytes]
  std::uint64_t offset = 0;  ///< in the wheel
  std::uint64_t packed = 0;  ///< [bytes] in the wheel
  std::string sha256;        ///< of the file itself
};

/// A file to fetch.
struct RemoteFile {
  std::string name;
  std::uint64_t size = 0;  ///< [bytes]
  std::string sha256;
};

/// All meshes of one robot, and where they can be had. Either source gives the same files.
struct MeshSet {
  std::string robot;   ///< what a user calls it
  std::string folder;  ///< of the shipped model, of the archive, and where the meshes are kept
  std::string licence;
  RemoteFile archive;   ///< MuJoCo Menagerie's release archive: tar.xz with FOLDER/assets/NAME
  RemoteFile wheel;     ///< a Python package that carries the same meshes
  std::string project;  ///< the name of that package in the index
  std::vector<MeshFile> files;
};

/// The robots whose meshes are known.
[[nodiscard]] std::span<const MeshSet> mesh_sets();

}  // namespace mjarm::app
