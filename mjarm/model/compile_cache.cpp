#include <algorithm>
#include <cstring>
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
constexpr std::size_t kMaxKept = UserCache::kMaxBytes / 4;  // of one model [bytes]

using Number = std::uint32_t;

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
    if (std::ranges::count(assets, file.path, &Asset::path) > 0) continue;
    assets.push_back(look_at(file.path, file.kind == "mesh" || file.kind == "texture"));
  }
  return CompileCache(std::move(*cache), key_of(source), std::move(assets));
}

std::optional<LoadedModel> CompileCache::find(const Read& read) const {
  const std::optional<std::string> value = cache_.find(key_);
  if (!value) return {};
  std::string_view left = *value;
  const auto take = [&](Number& number) {
    if (left.size() < sizeof number) return false;
    std::memcpy(&number, left.data(), sizeof number);
    left.remove_prefix(sizeof number);
    return true;
  };
  Number count = 0, index = 0;
  if (!take(count)) return {};
  for (Number k = 0; k < count; ++k) {
    if (!take(index) || index >= assets_.size() || left.size() < kHashDigits) return {};
    if (left.substr(0, kHashDigits) != hash_of(assets_[index].path)) return {};
    left.remove_prefix(kHashDigits);
  }
  return read(left);
}

void CompileCache::keep(std::string_view said, const LoadedModel& loaded) const {
  if (said.size() > kMaxKept) return;
  std::string value;
  const auto put = [&](std::size_t number) {
    const auto fixed = static_cast<Number>(number);
    value.append(reinterpret_cast<const char*>(&fixed), sizeof fixed);
  };
  std::vector<std::size_t> used;
  for (std::size_t k = 0; k < assets_.size(); ++k) {
    const std::string name = assets_[k].path.filename().string();
    if (!assets_[k].may_be_looks || std::ranges::count(loaded.read_files, name) > 0) {
      used.push_back(k);
    }
  }
  put(used.size());
  for (const std::size_t k : used) {
    put(k);
    value += hash_of(assets_[k].path);
    if (look_at(assets_[k].path, assets_[k].may_be_looks) != assets_[k]) return;
  }
  value += said;
  cache_.keep(key_, value);
}

}  // namespace mjarm
