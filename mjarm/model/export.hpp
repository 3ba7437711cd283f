#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// Formats a model can be written in.
enum class ExportFormat {
  mjcf,  ///< MuJoCo's XML; says all of the model, every number to the last bit
  urdf,  ///< links, joints, inertias, limits and shapes; see Exported::notes for the rest
  mjb,   ///< MuJoCo's binary of the compiled model with its meshes; for this MuJoCo version alone
};

/// "mjcf", "urdf" or "mjb". @return an error with the nearest word.
[[nodiscard]] Result<ExportFormat> export_format(std::string_view word);

/// A model in another format.
struct Exported {
  std::string content;             ///< of the file, to be written as it is
  std::vector<std::string> notes;  ///< what the format cannot say: one line each
};

/// Writes `model` out. Forward kinematics, masses, inertias and limits of the result are those of
/// `model`: bit by bit for MJCF and MJB, to rounding for URDF. Mesh files are referred to, relative
/// to `folder` where they lie in it, else by their absolute path.
///
/// In a URDF the root link `world` is the model's world, a body is a link of its name, a named site
/// a link without mass, and a body of several joints hangs on links between.
/// @param folder  where the file will stand.
/// @return impossible where the format cannot hold the model at all (ball joints in a URDF).
[[nodiscard]] Result<Exported> export_model(const Model& model, ExportFormat format,
                                            const std::filesystem::path& folder);

}  // namespace mjarm
