#pragma once

#include <filesystem>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/render/image.hpp"

namespace mjarm::render {

/// The picture as a PNG file in memory; equal pictures give equal bytes.
/// @return an error where the picture is empty or its size does not fit its data.
[[nodiscard]] Result<std::string> encode_png(const Image& image);

/// Writes the picture to `path` in one step: the whole new file or the old state.
[[nodiscard]] Result<void> write_png(const Image& image, const std::filesystem::path& path);

}  // namespace mjarm::render
