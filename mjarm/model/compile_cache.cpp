#include <algorithm>
#include <system_error>

#include "mjarm/core/sha256.hpp"
#include "mjarm/model/compile_cache_internal.hpp"
#include "mjarm/model/preflight_internal.hpp"

namespace mjarm {
namespace fs = std::filesystem;
namespace {

/// To be raised when compile_here() gives something else for the same.
constexpr const char* kModels = "mjarm models 1\n";
constexpr std::size_t kHashDigits = 64;
constexpr char kRead = 'r', kLooks = 'l';                   // before what is noted of a file
constexpr std::size_t kMaxKept = UserCache::kMaxBytes / 4;  // of one model [bytes]

/// All that decides about a model but the files its description names.
std::string key_of(const SpecSource& source) {
  std::string key = kModels;
  key += mj_versionString();
  for (const auto& document : source.files.documents()) {
    for (const std::string* part : {&document->name, &document->stands_for, &document->text}) {
      key += '\n' + std::to_string(part->size()) + '\n' + *part;
    }
  }
  return key;
}

/// As many digits as of a hash, also of a file that is not there.
std::string hash_of(const fs::path& file) {
  const Result<std::string> hash = sha256_of_file(file);
  return hash ? *hash : std::string(kHashDigits, '-');
}

}  // namespace

CompileCache::Asset CompileCache::look_at(const fs::path& path, bool may_be_looks) {
  Asset asset{path, may_be_looks};
  std::error_code absent;
  asset.changed = fs::last_write_time(path, absent);
  asset.size = fs::file_size(path, absent);
  return asset;
}

std::optional<CompileCache> CompileCache::of(const SpecSource& source) {
  if (source.looks || source.text != nullptr || source.prepare) return {};
  std::optional<UserCache> cache = UserCache::of_user();
  if (!cache) return {};
  std::vector<Asset> assets;
  for (const AssetFile& file : asset_files(source.files)) {
    if (file.kind == "model") return {};
    const bool may_be_looks = file.kind == "mesh" || file.kind == "texture";
    const auto known = std::ranges::find(assets, file.path, &Asset::path);
    if (known == assets.end()) {
      assets.push_back(look_at(file.path, may_be_looks));
    } else {
      known->may_be_looks = known->may_be_looks && may_be_looks;
    }
  }
  return CompileCache(std::move(*cache), key_of(source), std::move(assets));
}

std::string CompileCache::note_of(const Asset& asset, bool is_read) {
  if (is_read) return hash_of(asset.path);
  std::string note =
      std::to_string(asset.size) + ' ' + std::to_string(asset.changed.time_since_epoch().count());
  note.resize(kHashDigits, ' ');
  return note;
}

std::optional<LoadedModel> CompileCache::find(const Read& read) const {
  const std::optional<std::string> value = cache_.find(key_);
  if (!value) return {};
  std::string_view left = *value;
  for (const Asset& asset : assets_) {
    if (left.size() < 1 + kHashDigits) return {};
    const bool is_read = left.front() == kRead;
    if (left.substr(1, kHashDigits) != note_of(asset, is_read)) return {};
    left.remove_prefix(1 + kHashDigits);
  }
  return read(left);
}

void CompileCache::keep(std::string_view said, const LoadedModel& loaded) const {
  if (said.size() > kMaxKept) return;
  std::string value;
  for (const Asset& asset : assets_) {
    const std::string name = asset.path.filename().string();
    const bool is_read = !asset.may_be_looks || std::ranges::count(loaded.read_files, name) > 0;
    value += is_read ? kRead : kLooks;
    value += note_of(asset, is_read);
    if (look_at(asset.path, asset.may_be_looks) != asset) return;
  }
  value += said;
  cache_.keep(key_, value);
}

}  // namespace mjarm
