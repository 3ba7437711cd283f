#pragma once

#include <filesystem>
#include <utility>

#include "mjarm/core/os_lock.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm {

/// A folder for the files of a run, in which no other process may run something at the same time.
class OutputFolder {
 public:
  /// Makes the folder and those above it, and takes away what killed processes left unfinished in
  /// it (AtomicFile's temporary files).
  /// @return an error where it cannot be made or is a file; `impossible` with the number of the
  ///         process that works in it.
  [[nodiscard]] static Result<OutputFolder> open(const std::filesystem::path& folder);

 private:
  explicit OutputFolder(FolderLock lock) : lock_(std::move(lock)) {}
  FolderLock lock_;
};

}  // namespace mjarm
