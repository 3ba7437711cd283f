#pragma once

#include <filesystem>
#include <utility>

#include "mjarm/core/long_result.hpp"
#include "mjarm/core/os_lock.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm {

/// A folder for the files of a run, in which no other process may run something at the same time.
class OutputFolder {
 public:
  /// Makes the folder and those above it, and takes away what killed processes left unfinished in
  /// it (AtomicFile's temporary files).
  /// @return an error where it cannot be made or is a file; `impossible` with the number of the
  ///         process that works in it; `usage` where what lies in it took long (LongResult).
  [[nodiscard]] static Result<OutputFolder> open(const std::filesystem::path& folder,
                                                 const Replace& replace = {});

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return result_.path(); }
  /// All files of the run stand whole.
  void made() const noexcept { result_.made(); }

 private:
  OutputFolder(FolderLock lock, LongResult result)
      : lock_(std::move(lock)), result_(std::move(result)) {}
  FolderLock lock_;
  LongResult result_;
};

}  // namespace mjarm
