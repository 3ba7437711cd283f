#pragma once

#include <filesystem>
#include <string>

#include "mjarm/core/result.hpp"

namespace mjarm::install {

/// The shipped `scene` as one MJCF file in which meshes take the place of the drawn shapes: its
/// includes are put in, and for each body named in `meshes.xml` beside it, the geoms of the classes
/// `look...` are replaced by those listed there. Nothing else changes, not even the writing of a
/// number, so that the physics are the same to the last bit. Meshes are looked for in `assets`.
[[nodiscard]] Result<std::string> mesh_scene(const std::filesystem::path& scene);

}  // namespace mjarm::install
