#include <algorithm>
#include <array>
#include <string_view>

#include "mjarm/core/messages/guard.hpp"
#include "mjarm/model/preflight_internal.hpp"
#include "mjarm/model/urdf_internal.hpp"

namespace mjarm {
namespace fs = std::filesystem;
namespace {

using tinyxml2::XMLElement;

/// Elements of MJCF that name files, and the settings of <compiler> that say where they lie.
struct FileKind {
  std::string_view element;
  const char* folder;  ///< besides assetdir; null = beside the model
};
constexpr std::array<FileKind, 6> kKinds = {{{"mesh", "meshdir"},
                                             {"hfield", "meshdir"},
                                             {"skin", "meshdir"},
                                             {"flexcomp", "meshdir"},
                                             {"texture", "texturedir"},
                                             {"model", nullptr}}};

/// Where MJCF says that its files lie.
class Folders {
 public:
  explicit Folders(const XmlSources& sources)
      : base_(fs::path(sources.documents().front()->name).parent_path()) {
    for (const SourceElement& source : sources.elements()) {
      if (std::string_view(source.element->Name()) == "compiler")
        compilers_.push_back(source.element);
    }
  }

  /// Where `name` may be looked for.
  [[nodiscard]] std::vector<fs::path> places(const FileKind& kind, std::string_view name) const {
    std::vector<fs::path> folders = {base_};
    for (const XMLElement* compiler : compilers_) {
      for (const char* setting : {kind.folder, kind.folder != nullptr ? "assetdir" : nullptr}) {
        const char* folder = setting != nullptr ? compiler->Attribute(setting) : nullptr;
        if (folder != nullptr) folders.push_back(base_ / folder);
      }
    }
    // The folder of the model counts where no other is named.
    if (folders.size() > 1) folders.erase(folders.begin());
    const fs::path file = strips_paths() ? fs::path(name).filename() : fs::path(name);
    for (fs::path& folder : folders) folder /= file;
    return folders;
  }

 private:
  [[nodiscard]] bool strips_paths() const {
    bool strips = false;
    for (const XMLElement* compiler : compilers_) {
      const char* word = compiler->Attribute("strippath");
      if (word == nullptr) continue;
      if (std::string_view(word) != "true") return false;
      strips = true;
    }
    return strips;
  }

  fs::path base_;
  std::vector<const XMLElement*> compilers_;
};

}  // namespace

std::vector<AssetFile> asset_files(const XmlSources& sources) {
  const Folders folders(sources);
  std::vector<AssetFile> out;
  for (const SourceElement& source : sources.elements()) {
    const auto kind = std::find_if(kKinds.begin(), kKinds.end(), [&](const FileKind& k) {
      return k.element == source.element->Name();
    });
    if (kind == kKinds.end()) continue;
    for (const auto* a = source.element->FirstAttribute(); a != nullptr; a = a->Next()) {
      // Textures have `fileup`, `fileleft`, ... as well; what a URDF calls `filename` is checked
      // where its packages are known.
      const std::string_view attribute = a->Name();
      if (!attribute.starts_with("file") || attribute == "filename" || *a->Value() == '\0') {
        continue;
      }
      for (fs::path& path : folders.places(*kind, a->Value())) {
        out.push_back({std::move(path), kind->element, a->Value(), source});
      }
    }
  }
  return out;
}

Result<void> check_files(const XmlSources& sources, const LoadOptions& options) {
  const fs::path base = fs::path(sources.documents().front()->name).parent_path();
  for (const AssetFile& file : asset_files(sources)) {
    const SourceElement& source = file.source;
    if (!options.allow_outside && !is_inside(file.path, {base})) {
      return fail(urdf_error(*source.file, *source.element, text(msg::guard_outside, file.name)));
    }
    if (auto fault = asset_fault(file.path, file.kind, file.name)) {
      return fail(urdf_error(*source.file, *source.element, *fault));
    }
  }
  return {};
}

}  // namespace mjarm
