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

  [[nodiscard]] const fs::path& base() const { return base_; }

  /// Where `name` may be looked for. Which of several <compiler> counts need not be known: all must
  /// be harmless.
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

Result<void> check_files(const XmlSources& sources, const LoadOptions& options) {
  const Folders folders(sources);
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
      for (const fs::path& path : folders.places(*kind, a->Value())) {
        if (!options.allow_outside && !is_inside(path, {folders.base()})) {
          return fail(
              urdf_error(*source.file, *source.element, text(msg::guard_outside, a->Value())));
        }
        if (auto fault = asset_fault(path, kind->element, a->Value())) {
          return fail(urdf_error(*source.file, *source.element, *fault));
        }
      }
    }
  }
  return {};
}

}  // namespace mjarm
