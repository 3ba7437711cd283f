#include "mjarm/install/mesh_store.hpp"

#include <system_error>

#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/install.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/sha256.hpp"

namespace mjarm::install {

namespace fs = std::filesystem;

Result<fs::path> data_folder() {
  if (const auto data = user_folder("XDG_DATA_HOME", ".local/share")) return *data / "mjarm";
  return fail(Errc::system, text(msg::install_no_home));
}

fs::path mesh_folder(const fs::path& data, const MeshSet& set) {
  return data / "models" / set.folder;
}

MeshState check_meshes(const fs::path& folder, const MeshSet& set, const std::string& scene) {
  using Kind = MeshState::Kind;
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
  bool any = false;
  for (const fs::path& folder : {mesh_folder(data, set), data / "unfinished" / set.folder}) {
    std::error_code code;
    any |= fs::remove_all(folder, code) > 0;
    if (code) {
      return fail(Errc::system, text(msg::core_cannot_write, folder.string(), code.message()));
    }
  }
  // Folders that are empty now go as well; not the data folder, which others may wait to lock.
  for (const fs::path& folder : {data / "models", data / "unfinished"}) {
    std::error_code ignored;
    fs::remove(folder, ignored);
  }
  return any;
}

}  // namespace mjarm::install
