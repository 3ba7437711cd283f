#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/user_cache.hpp"
#include "mjarm/model/load_internal.hpp"

namespace mjarm {

/// What MuJoCo made of a description, in UserCache, as most of the time before a first plan is its
/// work on meshes. Kept under all text of the description, with the SHA-256 of every mesh and field
/// that decided about it, and size and date of those that are only looked at, which MuJoCo reads at
/// times and may refuse: where one of these has changed, nothing is known. Only of models without
/// looks; those that a description puts together from others (<model>) are not kept.
class CompileCache {
 public:
  using Read = std::function<std::optional<LoadedModel>(std::string_view said)>;

  /// @param source  to be compiled; outlives this. None where there is no cache for it.
  [[nodiscard]] static std::optional<CompileCache> of(const SpecSource& source);

  /// @param read  makes a model of what `keep()` was given; none where it cannot.
  [[nodiscard]] std::optional<LoadedModel> find(const Read& read) const;
  /// @param said  whatever `read` needs.
  /// @param loaded  the same, read. Files that changed since `of()` are not trusted.
  void keep(std::string_view said, const LoadedModel& loaded) const;

 private:
  /// A file that the description names, or a place where it might be.
  struct Asset {
    std::filesystem::path path;
    bool may_be_looks = false;  ///< a mesh or texture
    std::filesystem::file_time_type changed{};
    std::uintmax_t size = 0;
    [[nodiscard]] bool operator==(const Asset&) const = default;
  };
  /// Of a file that decides about the model its hash, else size and date.
  static std::string note_of(const Asset& asset, bool is_read);
  static Asset look_at(const std::filesystem::path& path, bool may_be_looks);
  CompileCache(UserCache cache, std::string key, std::vector<Asset> assets)
      : cache_(std::move(cache)), key_(std::move(key)), assets_(std::move(assets)) {}

  UserCache cache_;
  std::string key_;
  std::vector<Asset> assets_;
};

}  // namespace mjarm
