#include "mjarm/install/mesh_store.hpp"

#include <system_error>

#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/install.hpp"
#include "mjarm/core/sha256.hpp"
#include "mjarm/install/stage_internal.hpp"

namespace mjarm::install {

namespace fs = std::filesystem;

fs::path mesh_folder(const fs::path& data, const MeshSet& set) {
  return data / "models" / set.folder;
}

InstallState check_meshes(const fs::path& folder, const MeshSet& set, const std::string& scene) {
  using Kind = InstallState::Kind;
  std::error_code ignored;
  if (!fs::exists(folder, ignored)) return {};
  for (const MeshFile& mesh : set.files) {
    const fs::path file = folder / "assets" / mesh.name;
    if (!fs::is_regular_file(file, ignored)) {
      return {Kind::damaged, text(msg::core_no_such_file, file.string())};
    }
    if (const Result<std::string> hash = sha256_of_file(file); !hash) {
      return {Kind::damaged, hash.error().what};
    } else if (*hash != mesh.sha256) {
      return {Kind::damaged, text(msg::install_changed, file.string())};
    }
  }
  const fs::path file = folder / "scene.xml";
  const Result<std::string> text_there = read_file(file);
  if (!text_there) return {Kind::damaged, text_there.error().what};
  if (*text_there != scene) return {Kind::outdated, text(msg::install_outdated, file.string())};
  return {Kind::whole, ""};
}

Result<bool> remove_meshes(const fs::path& data, const MeshSet& set) {
  return remove_installed(data, mesh_folder(data, set), set.folder);
}

}  // namespace mjarm::install
