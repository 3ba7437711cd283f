#pragma once

#include <filesystem>
#include <optional>
#include <utility>

#include "mjarm/core/result.hpp"

namespace mjarm {

/// A folder that one process at a time works in. The lock ends with this object, and with the
/// process however that ends; it leaves no file behind.
class FolderLock {
 public:
  /// @param folder  must exist.
  /// @return none where another process holds it.
  [[nodiscard]] static Result<std::optional<FolderLock>> try_lock(
      const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept : handle_(std::exchange(other.handle_, -1)) {}
  FolderLock& operator=(FolderLock&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }

 private:
  explicit FolderLock(int handle) : handle_(handle) {}
  int handle_;
};

/// Number of the process that holds the lock of a folder; none where the system does not tell.
[[nodiscard]] std::optional<long> lock_holder(const std::filesystem::path& folder);

}  // namespace mjarm
