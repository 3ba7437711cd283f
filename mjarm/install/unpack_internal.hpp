#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/install/mesh_sets.hpp"

namespace mjarm::install {

/// Takes one unpacked mesh whose size and hash are right.
using MeshSink = std::function<Result<void>(const MeshFile& mesh, const std::string& content)>;

/// Unpacks the meshes of `set` from `part`, the bytes of its wheel from `offset` on. Only places
/// and hashes that are known beforehand count; nothing in the file is believed.
/// @return an error that names the file and the mesh that is missing or damaged.
[[nodiscard]] Result<void> unpack(const std::filesystem::path& part, std::uint64_t offset,
                                  const MeshSet& set, const MeshSink& sink);

}  // namespace mjarm::install
