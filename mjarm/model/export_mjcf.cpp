#include <mujoco/mujoco.h>

#include <utility>

#include "mjarm/core/messages/model.hpp"
#include "mjarm/model/export_internal.hpp"
#include "mjarm/model/grip_mend_internal.hpp"
#include "mjarm/model/load_internal.hpp"
#include "mjarm/model/mujoco_guard.hpp"
#include "mjarm/model/spec_origin_internal.hpp"

namespace mjarm {
namespace fs = std::filesystem;
namespace {

// MuJoCo 4.0.0, with which the package of Python may run, lacks it: there cube maps of six files
// keep their names.
#pragma weak mjs_getInStringVec

constexpr int kErrorSize = 1024;

/// Renames the files of a description that will stand in another folder.
class FileNames {
 public:
  FileNames(mjSpec* spec, const fs::path& source, const fs::path& folder)
      : spec_(spec), source_(fs::absolute(source).parent_path()), folder_(folder) {}

  /// @return true where a file stays outside the folder.
  bool rename() {
    const fs::path meshes = directory(spec_->compiler.meshdir);
    const fs::path textures = directory(spec_->compiler.texturedir);
    for_each(mjOBJ_MESH, [&](mjsElement* e) { move(mjs_asMesh(e)->file, meshes); });
    for_each(mjOBJ_HFIELD, [&](mjsElement* e) { move(mjs_asHField(e)->file, meshes); });
    for_each(mjOBJ_SKIN, [&](mjsElement* e) { move(mjs_asSkin(e)->file, meshes); });
    for_each(mjOBJ_TEXTURE, [&](mjsElement* e) {
      mjsTexture* texture = mjs_asTexture(e);
      move(texture->file, textures);
      for (int side = 0; side < 6 && &mjs_getInStringVec != nullptr; ++side) {
        const std::string name = mjs_getInStringVec(texture->cubefiles, side);
        if (!name.empty()) {
          mjs_setInStringVec(texture->cubefiles, side, moved(name, textures).c_str());
        }
      }
    });
    mjs_setString(spec_->compiler.meshdir, "");
    mjs_setString(spec_->compiler.texturedir, "");
    return outside_;
  }

 private:
  template <class Work>
  void for_each(mjtObj type, const Work& work) {
    for (mjsElement* e = mjs_firstElement(spec_, type); e; e = mjs_nextElement(spec_, e)) work(e);
  }
  [[nodiscard]] fs::path directory(const mjString* name) const {
    return source_ / mjs_getString(name);
  }
  std::string moved(const std::string& name, const fs::path& directory) {
    const fs::path path = spec_->strippath ? fs::path(name).filename() : fs::path(name);
    const std::string out = name_from(folder_, directory / path);
    outside_ = outside_ || fs::path(out).is_absolute();
    return out;
  }
  void move(mjString* file, const fs::path& directory) {
    const std::string name = mjs_getString(file);
    if (!name.empty()) mjs_setString(file, moved(name, directory).c_str());
  }

  mjSpec* spec_;
  fs::path source_;
  fs::path folder_;
  bool outside_ = false;
};

/// MuJoCo's own text of a description; empty, with `error` filled, where it has none.
std::string saved(const mjSpec* spec, std::string& error) {
  std::string xml(std::size_t{1} << 20, '\0');
  char words[kErrorSize] = "";
  int left = 0;
  const auto save = [&] {
    left = mj_saveXMLString(spec, xml.data(), static_cast<int>(xml.size()), words, kErrorSize);
  };
  MujocoOutcome outcome = call_mujoco(save);
  if (!outcome.failed && left > 0) {  // the size that is needed
    xml.assign(static_cast<std::size_t>(left) + 1, '\0');
    outcome = call_mujoco(save);
  }
  if (outcome.failed || left != 0) {
    error = outcome.failed ? outcome.error : words;
    return "";
  }
  xml.resize(xml.find('\0'));
  return xml;
}

/// Text of `model` with what `change` does to its description first.
template <class Change>
Result<Exported> export_changed(const Model& model, const fs::path& folder, const Change& change) {
  const std::string file = model.file().string();
  std::string error;
  const MjSpecPtr spec = SpecOrigin(model).parse(error);
  if (spec == nullptr) return fail(Errc::impossible, text(msg::model_not_exported, file, error));
  if (!change(*spec)) return fail(Errc::impossible, text(msg::model_file_changed, file));
  Exported exported;
  if (FileNames(spec.get(), model.file(), folder).rename()) {
    exported.notes.push_back(text(msg::model_files_stay));
  }
  spec->strippath = 0;
  // MuJoCo rounds what it compiled to six digits, but writes what was written to the last one
  // (Programming, Model Editing, "Model Encoding & Saving").
  spec->compiler.savecompiled = 0;
  spec->compiler.savecanonical = 1;
  exported.content = saved(spec.get(), error);
  if (exported.content.empty()) {
    return fail(Errc::impossible, text(msg::model_not_exported, file, error));
  }
  return exported;
}

}  // namespace

Result<Exported> export_mjcf(const Model& model, const fs::path& folder) {
  return export_changed(model, folder, [](mjSpec&) { return true; });
}

Result<Exported> export_mended(const Model& model, const GripMend& mend, const fs::path& folder) {
  return export_changed(model, folder,
                        [&](mjSpec& spec) { return detail::apply(mend, *model.raw(), spec); });
}

}  // namespace mjarm
