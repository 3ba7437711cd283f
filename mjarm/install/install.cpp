#include "mjarm/install/install.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <system_error>
#include <thread>

#include "mjarm/core/file.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/install.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/install/mesh_store.hpp"
#include "mjarm/install/package_index_internal.hpp"
#include "mjarm/install/unpack_internal.hpp"

namespace mjarm::install {
namespace {

namespace fs = std::filesystem;

Error write_error(const fs::path& path, const std::error_code& code) {
  return {Errc::system, text(msg::core_cannot_write, path.string(), code.message())};
}

Result<void> make_folders(const fs::path& folder) {
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) return fail(write_error(folder, code));
  return {};
}

/// One install in progress.
struct Job {
  const MeshSet& set;
  fs::path work;   ///< of this robot, kept until it is installed
  fs::path stage;  ///< in `work`: becomes the folder of the meshes
  fs::path part;   ///< in `work`: what was downloaded
};

/// Of the wheel only the part in which the meshes of this robot lie. A part left by an earlier run
/// may have been damaged since: then all is fetched anew, once.
Result<void> fetch(const Job& job, const std::string& url, const HttpOptions& http) {
  ByteRange range{job.set.files.front().offset, 0};
  for (const MeshFile& mesh : job.set.files) {
    range.from = std::min(range.from, mesh.offset);
    range.to = std::max(range.to, mesh.offset + mesh.packed);
  }
  const auto write = [&job](const MeshFile& mesh, const std::string& content) -> Result<void> {
    if (interrupted()) return fail(Errc::impossible, text(msg::install_interrupted));
    return write_file(job.stage / "assets" / mesh.name, content);
  };
  std::error_code ignored;
  for (bool resumed = fs::exists(job.part, ignored);; resumed = false) {
    const std::string label = text(msg::install_downloading, job.set.robot);
    if (auto done = download(url, range, job.part, label, http); !done) return done;
    Result<void> done = unpack(job.part, range.from, job.set, write);
    if (done || done.error().code != Errc::not_available) return done;
    fs::remove(job.part, ignored);
    if (!resumed) return done;
    log_info(text(msg::install_again, done.error().what));
  }
}

/// After a failure only what was downloaded stays.
void tidy(const Job& job) {
  std::error_code ignored;
  fs::remove_all(job.stage, ignored);
  if (fs::is_empty(job.part, ignored)) fs::remove(job.part, ignored);
  for (const fs::path& folder : {job.work, job.work.parent_path()}) {
    fs::remove(folder, ignored);  // where nothing is in it
  }
}

/// Puts the verified stage in its place. Ended half way, no meshes or the old ones are there, and
/// the next install has all it needs in `work`.
Result<void> publish(const Job& job, const fs::path& target) {
  if (auto made = make_folders(target.parent_path()); !made) return made;
  std::error_code code;
  const fs::path old = job.work / "old";
  fs::remove_all(old, code);
  if (!code && fs::exists(fs::symlink_status(target, code))) fs::rename(target, old, code);
  if (code && code != std::errc::no_such_file_or_directory) return fail(write_error(target, code));
  fs::rename(job.stage, target, code);
  if (code) return fail(write_error(target, code));
  fs::remove_all(job.work, code);
  if (code) return fail(write_error(job.work, code));
  fs::remove(job.work.parent_path(), code);  // where no other robot is unfinished
  return {};
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
  const fs::path work = data / "unfinished" / set.folder;
  const Job job{
      .set = set, .work = work, .stage = work / "stage", .part = work / (set.wheel + ".part")};
  std::error_code code;
  fs::remove_all(job.stage, code);
  if (code) return fail(write_error(job.stage, code));
  const auto url = [&]() -> Result<std::string> {
    if (!from.empty()) return from + "/" + set.wheel;
    return find_in_index(index, set.project, set.wheel, set.wheel_sha256);
  };
  Result<void> done = make_folders(job.stage / "assets")
                          .and_then(url)
                          .and_then([&](const auto& it) { return fetch(job, it, index.http); })
                          .and_then([&] { return write_file(job.stage / "scene.xml", scene); });
  if (done) {
    // Read back: what counts is what the disk gives.
    const MeshState state = check_meshes(job.stage, set, scene);
    const bool whole = state.kind == MeshState::Kind::whole;
    done = whole ? publish(job, mesh_folder(data, set)) : fail(Errc::system, state.problem);
  }
  if (!done) tidy(job);
  return done;
}

}  // namespace mjarm::install
