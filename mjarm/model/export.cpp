#include "mjarm/model/export.hpp"

#include <mujoco/mujoco.h>

#include <array>
#include <memory>
#include <utility>

#include "mjarm/core/messages/model.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/model/export_internal.hpp"
#include "mjarm/model/load_internal.hpp"
#include "mjarm/model/mujoco_guard.hpp"

namespace mjarm {
namespace fs = std::filesystem;
namespace {

constexpr std::array<std::pair<std::string_view, ExportFormat>, 3> kFormats = {
    {{"mjcf", ExportFormat::mjcf}, {"urdf", ExportFormat::urdf}, {"mjb", ExportFormat::mjb}}};

Result<Exported> export_mjb(const Model& model) {
  constexpr int kErrorSize = 1024;
  char error[kErrorSize] = "";
  mjModel* whole = nullptr;
  std::string content;
  const MujocoOutcome outcome = call_mujoco([&] {
    whole = mj_embedAssets(model.raw(), error, kErrorSize);
    if (whole == nullptr) return;
    content.resize(static_cast<std::size_t>(mj_sizeModel(whole)));
    mj_saveModel(whole, nullptr, content.data(), static_cast<mjtSize>(content.size()));
  });
  const MjModelPtr owner(whole);
  if (outcome.failed || whole == nullptr) {
    return fail(Errc::impossible, text(msg::model_not_exported, model.file().string(),
                                       outcome.failed ? outcome.error : error));
  }
  return Exported{std::move(content), {text(msg::model_mjb_version, mj_versionString())}};
}

}  // namespace

std::string name_from(const fs::path& folder, const fs::path& file) {
  const fs::path relative =
      file.lexically_normal().lexically_relative(fs::absolute(folder).lexically_normal());
  const bool inside = !relative.empty() && *relative.begin() != "..";
  return (inside ? relative : file.lexically_normal()).generic_string();
}

Result<ExportFormat> export_format(std::string_view word) {
  std::vector<std::string> words;
  for (const auto& [name, format] : kFormats) {
    if (name == word) return format;
    words.emplace_back(name);
  }
  return fail(Errc::usage, text(msg::model_unknown_format, word, did_you_mean(word, words)));
}

Result<Exported> export_model(const Model& model, ExportFormat format, const fs::path& folder) {
  switch (format) {
    case ExportFormat::mjcf:
      return export_mjcf(model, folder);
    case ExportFormat::urdf:
      return export_urdf(model, folder);
    case ExportFormat::mjb:
      break;
  }
  return export_mjb(model);
}

}  // namespace mjarm
