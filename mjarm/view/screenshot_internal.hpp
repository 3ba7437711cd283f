#pragma once

#include <filesystem>

#include "mjarm/core/result.hpp"
#include "mjarm/render/image.hpp"

namespace mjarm::view {

/// Writes `image` into `folder`, which is made where it is missing, as the first of
/// `mjarm-001.png`, `mjarm-002.png`, ... that is not there.
/// @return the file.
[[nodiscard]] Result<std::filesystem::path> save_screenshot(const render::Image& image,
                                                            const std::filesystem::path& folder);

}  // namespace mjarm::view
