#pragma once

#include <nanobind/nanobind.h>

#include <filesystem>
#include <optional>

#include "mjarm/render/image.hpp"
#include "mjarm/render/plot.hpp"

namespace mjarm::python {

/// Anything like an array of shape (height, width, 3), uint8.
/// @throws a BadInput that names the argument.
[[nodiscard]] render::Image image_of(nanobind::handle value, const char* name);

/// (height, width, 3), uint8.
[[nodiscard]] nanobind::object array_of(const render::Image& image);

/// @throws a BadInput for a size that no picture can have.
void check_pixels(int width, int height);

/// As PNG in bytes, or None where it went to a file, a .png (charts: or a .svg).
/// @throws a BadInput for another extension, SystemFault where it cannot be written.
[[nodiscard]] nanobind::object give(const render::Image& image,
                                    const std::optional<std::filesystem::path>& file);
[[nodiscard]] nanobind::object give(const render::Plot& page,
                                    const std::optional<std::filesystem::path>& file);

/// The picture as PNG.
[[nodiscard]] nanobind::bytes png_of(const render::Image& image);

}  // namespace mjarm::python
