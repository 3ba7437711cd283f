#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "apps/mjarm/install/mesh_sets.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::app {

/// Takes one unpacked mesh whose size and hash are right.
using MeshSink = std::function<Result<void>(const MeshFile& mesh, const std::string& content)>;

/// Unpacks the meshes of `set` from its tar archive (xz, gzip or plain); other entries are passed
/// over, one that points out of its folder is refused.
/// @return an error that names the archive and the mesh that is missing or damaged.
[[nodiscard]] Result<void> unpack_archive(const std::filesystem::path& archive, const MeshSet& set,
                                          const MeshSink& sink);

/// Unpacks the meshes of `set` from `part`, the bytes of its wheel from `offset` on.
[[nodiscard]] Result<void> unpack_wheel_part(const std::filesystem::path& part,
                                             std::uint64_t offset, const MeshSet& set,
                                             const MeshSink& sink);

}  // namespace mjarm::app
