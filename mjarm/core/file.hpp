#pragma once

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "mjarm/core/result.hpp"

namespace mjarm {

/// Whole content of a regular file (or of what can be read like one).
/// @return an error that names the path where it is missing, a folder, unreadable or above
///         `max_bytes`.
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& path,
                                            std::size_t max_bytes = std::size_t{1} << 31);

/// Writes `content` to `path` in one step: either the whole new file stands there or the old state.
[[nodiscard]] Result<void> write_file(const std::filesystem::path& path, std::string_view content);

/// Makes `folder` and those above it. @return an error where it cannot be made or is a file.
[[nodiscard]] Result<void> make_folder(const std::filesystem::path& folder);

/// Number of the process that writes a temporary file of AtomicFile, by its name; none where `path`
/// is no such file.
[[nodiscard]] std::optional<long> writer_of_temporary(const std::filesystem::path& path);

/// A file that appears under its name only when `commit` succeeds; until then it grows under a
/// temporary name beside it, which vanishes with this object. A path that is no regular file
/// (a pipe, /dev/null) is written directly.
class AtomicFile {
 public:
  /// Creates the temporary file; folders that are missing are an error.
  [[nodiscard]] static Result<AtomicFile> create(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) noexcept;

  /// Where it grows until `commit`, for another program that writes it in the place of `write`.
  [[nodiscard]] const std::filesystem::path& growing() const noexcept {
    return temporary_.empty() ? path_ : temporary_;
  }

  /// Appends; fails when the disk is full or the like.
  [[nodiscard]] Result<void> write(std::string_view content);
  /// Writes out what is buffered and puts the file in its place. Call once, last.
  [[nodiscard]] Result<void> commit();

 private:
  AtomicFile() = default;
  /// Closes and removes the temporary file, if it still stands.
  void discard() noexcept;

  std::filesystem::path path_;       ///< final name, for messages as the user gave it
  std::filesystem::path target_;     ///< final name with links followed
  std::filesystem::path temporary_;  ///< empty where `path_` is written directly
  std::FILE* file_ = nullptr;
};

}  // namespace mjarm
