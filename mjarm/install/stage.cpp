#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/install.hpp"
#include "mjarm/install/stage_internal.hpp"

namespace mjarm::install {

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

Stage::Stage(const fs::path& data, const std::string& folder, const std::string& file)
    : work(data / "unfinished" / folder), stage(work / "stage"), part(work / (file + ".part")) {}

Result<void> Stage::begin() const {
  std::error_code code;
  fs::remove_all(stage, code);
  if (code) return fail(write_error(stage, code));
  return make_folders(stage);
}

Result<void> Stage::fetch(const Source& source, const HttpOptions& http,
                          const std::function<Result<void>()>& unpack) const {
  std::error_code ignored;
  const std::string label = text(msg::install_downloading, source.name);
  for (bool resumed = fs::exists(part, ignored);; resumed = false) {
    if (auto done = download(source.url, source.range, part, label, http); !done) return done;
    Result<void> done = unpack();
    if (done || done.error().code != Errc::not_available) return done;
    fs::remove(part, ignored);
    if (!resumed) return done;
    log_info(text(msg::install_again, done.error().what));
  }
}

Result<void> Stage::publish(const fs::path& target) const {
  if (auto made = make_folders(target.parent_path()); !made) return made;
  std::error_code code;
  const fs::path old = work / "old";
  fs::remove_all(old, code);
  if (!code && fs::exists(fs::symlink_status(target, code))) fs::rename(target, old, code);
  if (code && code != std::errc::no_such_file_or_directory) return fail(write_error(target, code));
  fs::rename(stage, target, code);
  if (code) return fail(write_error(target, code));
  fs::remove_all(work, code);
  if (code) return fail(write_error(work, code));
  fs::remove(work.parent_path(), code);  // where nothing else is unfinished
  return {};
}

void Stage::tidy() const {
  std::error_code ignored;
  fs::remove_all(stage, ignored);
  if (fs::is_empty(part, ignored)) fs::remove(part, ignored);
  for (const fs::path& folder : {work, work.parent_path()}) {
    fs::remove(folder, ignored);  // where nothing is in it
  }
}

Result<bool> remove_installed(const fs::path& data, const fs::path& target,
                              const std::string& folder) {
  bool any = false;
  for (const fs::path& one : {target, data / "unfinished" / folder}) {
    std::error_code code;
    any |= fs::remove_all(one, code) > 0;
    if (code) return fail(write_error(one, code));
  }
  // Folders that are empty now go as well; not the data folder, which others may wait to lock.
  for (const fs::path& above : {target.parent_path(), data / "unfinished"}) {
    std::error_code ignored;
    if (above != data) fs::remove(above, ignored);
  }
  return any;
}

}  // namespace mjarm::install
