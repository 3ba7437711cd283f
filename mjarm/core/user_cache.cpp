#include "mjarm/core/user_cache.hpp"

#include <algorithm>
#include <atomic>
#include <system_error>
#include <vector>

#include "mjarm/core/file.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/sha256.hpp"

namespace mjarm {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kHash = 64;  // digits
constexpr const char* kEnding = ".mjarm-cache";

struct CachedFile {
  fs::path path;
  fs::file_time_type used;
  std::size_t size = 0;
};

/// Ours alone: whatever else lies there is left alone.
std::vector<CachedFile> files_in(const fs::path& folder) {
  std::vector<CachedFile> out;
  std::error_code failed;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
    std::error_code vanished;
    if (at->path().extension() != kEnding || !at->is_regular_file(vanished)) continue;
    CachedFile file{at->path(), at->last_write_time(vanished), 0};
    if (vanished) continue;
    const std::uintmax_t size = at->file_size(vanished);
    if (!vanished) file.size = static_cast<std::size_t>(size), out.push_back(std::move(file));
  }
  return out;
}

std::size_t size_of(const std::vector<CachedFile>& files) {
  std::size_t sum = 0;
  for (const CachedFile& file : files) sum += file.size;
  return sum;
}

std::atomic<bool> left_alone = false;

}  // namespace

void UserCache::leave_alone() noexcept { left_alone = true; }

std::optional<UserCache> UserCache::of_user() {
  if (left_alone || environment("MJARM_CACHE") == "off") return {};
  const auto folder = user_folder("XDG_CACHE_HOME", ".cache");
  if (!folder) return {};
  return UserCache(*folder / "mjarm");
}

fs::path UserCache::file_of(std::string_view made_from) const {
  return folder_ / (sha256(made_from) + kEnding);
}

std::optional<std::string> UserCache::find(std::string_view made_from) const {
  const fs::path file = file_of(made_from);
  std::error_code failed;
  if (!fs::is_regular_file(file, failed)) return {};
  Result<std::string> content = read_file(file, max_bytes_);
  if (!content || content->size() < kHash) return {};
  const std::string_view value(content->data(), content->size() - kHash);
  if (content->compare(value.size(), kHash, sha256(value)) != 0) {
    fs::remove(file, failed);
    return {};
  }
  fs::last_write_time(file, fs::file_time_type::clock::now(), failed);  // used
  content->resize(value.size());
  return std::move(*content);
}

void UserCache::keep(std::string_view made_from, std::string_view value) const {
  const std::size_t size = kHash + value.size();
  if (size > max_bytes_ || !make_folder(folder_)) return;
  make_room(size);
  std::string content(value);
  content += sha256(value);
  (void)write_file(file_of(made_from), content);
}

void UserCache::make_room(std::size_t bytes) const {
  std::vector<CachedFile> files = files_in(folder_);
  std::size_t sum = size_of(files) + bytes;
  if (sum <= max_bytes_) return;
  std::ranges::sort(files, {}, &CachedFile::used);
  for (const CachedFile& file : files) {
    if (sum <= max_bytes_) return;
    std::error_code failed;
    if (fs::remove(file.path, failed)) sum -= file.size;
  }
}

std::size_t UserCache::size() const { return size_of(files_in(folder_)); }

}  // namespace mjarm
