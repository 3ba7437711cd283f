#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "mjarm/core/result.hpp"
#include "mjarm/model/export.hpp"

/// The formats of export_model.
namespace mjarm {

[[nodiscard]] Result<Exported> export_mjcf(const Model& model, const std::filesystem::path& folder);
[[nodiscard]] Result<Exported> export_urdf(const Model& model, const std::filesystem::path& folder);

/// The name by which a description in `folder` calls the absolute path `file`: relative where the
/// file lies in the folder, else the path itself.
[[nodiscard]] std::string name_from(const std::filesystem::path& folder,
                                    const std::filesystem::path& file);

}  // namespace mjarm
