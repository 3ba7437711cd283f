#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace mjarm {

/// What took a while to compute, kept from run to run in a folder of the user: `$XDG_CACHE_HOME/
/// mjarm`, else `~/.cache/mjarm`. Files have the SHA-256 of what they were made from as names, so
/// that none is ever out of date, and hold that of what they say; one that was changed is as good
/// as none. Any number of processes may use it, and whoever likes may delete it at any time. What
/// cannot be written is not kept.
class UserCache {
 public:
  static constexpr std::size_t kMaxBytes = std::size_t{256} << 20;  ///< of all files

  /// None where the environment variable MJARM_CACHE is `off`, after leave_alone(), or where the
  /// user has no folder.
  [[nodiscard]] static std::optional<UserCache> of_user();
  /// From now on there is none for this process: what it measures is a first run.
  static void leave_alone() noexcept;
  /// @param max_bytes  of all files together; what was used longest ago goes.
  explicit UserCache(std::filesystem::path folder, std::size_t max_bytes = kMaxBytes)
      : folder_(std::move(folder)), max_bytes_(max_bytes) {}

  /// @param made_from  all that decides what the value is, a number of the algorithm included.
  [[nodiscard]] std::optional<std::string> find(std::string_view made_from) const;
  void keep(std::string_view made_from, std::string_view value) const;

  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }
  /// [bytes] Of all files now.
  [[nodiscard]] std::size_t size() const;

 private:
  [[nodiscard]] std::filesystem::path file_of(std::string_view made_from) const;
  void make_room(std::size_t bytes) const;

  std::filesystem::path folder_;
  std::size_t max_bytes_;
};

}  // namespace mjarm
